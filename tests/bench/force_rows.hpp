// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/bench_row.hpp"
#include "tests/bench/bumpy_sphere.hpp"
#include "tests/bench/cases.hpp"
#include "tests/bench/force_replay.hpp"

#include <cstdint>
#include <optional>

namespace tactus::bench
{

/// Accuracy of the forces of one sweep, in newtons.
struct ForceFigures
{
    Spread error_n;             ///< Error of the force against the exact surface.
    double largest_step_n{0.0}; ///< Greatest change of the force between frames.
    /// Frames in which the sphere is stuck: halted, without contact, or farther than `lag_m` from
    /// its rest position.
    std::uint64_t stuck{0};
    std::uint64_t without_force{0};
};
/// Accuracy of a trace; `rests_m` of the counted frames, in the frame of the trace.
[[nodiscard]] ForceFigures measure_forces(const ForceTrace& trace, const std::vector<Vec3>& goals_m,
                                          const std::vector<Vec3>& rests_m, const Touch& touch,
                                          double lag_m);

/// Goals of one sweep; infinite: none.
struct ForceGoals
{
    double frame_p99_us;
    double error_p99_n;
    double error_max_n;
    double step_n;
    bool has_laws{true}; ///< Requires no allocation and no stuck frame.
    double force_p99_us{kNoGoal};
};
/// Time after which a proxy that lagged is on the device again, once that slows down.
inline constexpr double kReturn_ms = 50.0;

/// Adds the rows of a sweep. `coarser_p99_n` is the same sweep's error on the next coarser mesh, if
/// there is one; the error must be smaller.
void add_force_rows(CaseRows& rows, const ForceTrace& trace, const ForceFigures& figures,
                    const ForceGoals& goals, std::optional<double> coarser_p99_n);

/// Adds the rows of a sweep without a known true force: times, allocations and frames without a
/// force, which must not occur.
void add_felt_rows(CaseRows& rows, const ForceTrace& trace, const ForceFigures& figures,
                   const ForceGoals& goals);

/// Adds the lag of the proxy behind a fast device, and its cost. From the counted frame `slows_at`
/// on, each of 1 ms, the device is slow; kReturn_ms later the proxy must be on it again.
void add_lag_rows(CaseRows& rows, const ForceTrace& trace, std::size_t slows_at);

/// Adds recorded figures of CHAI3D 3.3's finger proxy, for the order of magnitude: measured
/// elsewhere, on a similar surface whose constants were not kept.
void add_recorded_peer(Rows& rows);

} // namespace tactus::bench
