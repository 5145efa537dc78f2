// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/bench_report.hpp"
#include "tests/bench/cases.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::bench
{

/// A set of cases.
struct Suite
{
    const char* name;
    /// In their order; those that only run when named included.
    std::vector<Case> (*cases)();
    /// Its goals are laws: the program leaves with code 1 when one isn't met, asked or not.
    bool always_checks{false};
    /// What is printed unless every row is asked for.
    Figures printed{Figures::all};
};

[[nodiscard]] Suite counts_suite();
[[nodiscard]] Suite encoder_suite();
[[nodiscard]] Suite error_time_suite();
[[nodiscard]] Suite force_suite();
[[nodiscard]] Suite frame_suite();
[[nodiscard]] Suite growth_suite();
[[nodiscard]] Suite peers_suite();
[[nodiscard]] Suite skip_suite();
[[nodiscard]] Suite stability_suite();
[[nodiscard]] Suite scene_suite();
[[nodiscard]] Suite starve_suite();
[[nodiscard]] Suite stream_suite();
[[nodiscard]] Suite table1_suite();
[[nodiscard]] Suite table2_suite();
[[nodiscard]] Suite worst_suite();

/// In the order in which they are told.
[[nodiscard]] std::vector<Suite> all_suites();
[[nodiscard]] std::optional<Suite> find_suite(const std::string& name);
[[nodiscard]] std::vector<std::string> case_names(const Suite& suite);

/// Runs the chosen cases, each on one core, and adds what they bring. Returns a line when a case
/// failed, or measured a time whose result nothing looks at.
[[nodiscard]] std::optional<std::string> run_suite(const Suite& suite, const BenchOptions& options,
                                                   SceneStore& scenes, Rows& rows);

/// A failure when a row has the time of frames but no hash over them: what was timed may then be
/// nothing at all.
void check_hashes(std::span<const Row> rows);

} // namespace tactus::bench
