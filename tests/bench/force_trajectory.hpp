// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/bench_options.hpp"
#include "tests/bench/bench_row.hpp"
#include "tests/bench/force_replay.hpp"
#include "tests/bench/trajectory_file.hpp"

#include <optional>
#include <string>

namespace tactus::bench
{

/// How a trajectory's samples become frames: one each. The period is the median of the times
/// between them; longer gaps are whole numbers of periods, at least one. The device follows at up
/// to 1.5 times the fastest sample.
[[nodiscard]] ForceRun make_trajectory_run(const Scene& scene, const Trajectory& trajectory,
                                           double radius_m, double stiffness_n_per_m);

/// How far forces are from the recorded ones: the lengths of the differences, or, where only
/// amounts were recorded, the differences of lengths.
struct ForceDifference
{
    double rms_n{0.0};
    double max_n{0.0};
    double max_time_s{0.0}; ///< Of the sample.
};
/// `outputs`, one a sample.
[[nodiscard]] ForceDifference compare_forces(const std::vector<ToolOutput>& outputs,
                                             const Trajectory& trajectory);

/// Replays the recorded positions over the mesh, fully refined on a grid of 20 bits, and adds the
/// rows that compare the forces. The proxy starts at the first sample, which is to be outside the
/// mesh. Returns a line when a file can't be read or the mesh can't be encoded.
[[nodiscard]] std::optional<std::string> compare_trajectory(const BenchOptions& options,
                                                            Rows& rows);

} // namespace tactus::bench
