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

/// Set of cases.
struct Suite
{
    const char* name;
    /// Cases in order, including those that only run if named.
    std::vector<Case> (*cases)();
    /// True if a missed goal always causes exit code 1, even without a request.
    bool always_checks{false};
};

[[nodiscard]] Suite counts_suite();
[[nodiscard]] Suite edits_suite();
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

/// Cases of the suite scene: cost of a model server's objects on the wire and for joining
/// controllers.
[[nodiscard]] std::vector<Case> scene_wire_cases();

/// All suites in the order of printing.
[[nodiscard]] std::vector<Suite> all_suites();
[[nodiscard]] std::optional<Suite> find_suite(const std::string& name);
[[nodiscard]] std::vector<std::string> case_names(const Suite& suite);

/// Runs the chosen cases, each on one core, and adds their rows. Returns a line if a case failed,
/// or timed a result that nothing uses.
[[nodiscard]] std::optional<std::string> run_suite(const Suite& suite, const BenchOptions& options,
                                                   SceneStore& scenes, Rows& rows);

/// A failure if a row has a time of frames without a hash over them, since nothing may have been
/// timed.
void check_hashes(std::span<const Row> rows);

} // namespace tactus::bench
