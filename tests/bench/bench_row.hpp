// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tactus::bench
{

/// One figure of one case. All suites use the same rows.
struct Row
{
    std::string suite;
    std::string test_case;
    std::string metric;
    double value{0.0};
    std::string unit;
    std::string scene;
    std::uint64_t seed{0};
    std::uint64_t frames{0};
    std::uint64_t hash{0}; ///< State hash summed over the frames: the same work was measured.
    std::optional<std::string> peer;
    double peer_value{0.0};
};

using Rows = std::vector<Row>;

struct BenchOptions
{
    bool quick{false}; ///< Fewer frames and repeats; the same cases.
};

/// A suite adds its rows. Returns a line when it could not be run.
using Suite = std::optional<std::string> (*)(const BenchOptions& options, Rows& rows);

std::optional<std::string> run_frame_suite(const BenchOptions& options, Rows& rows);

/// The rows as a table for a terminal, a line for each scene, case and metric.
[[nodiscard]] std::string to_table(const Rows& rows);
/// {"schema":1,"commit","machine","compiler","rows":[...]}.
[[nodiscard]] std::string to_json(const Rows& rows);

} // namespace tactus::bench
