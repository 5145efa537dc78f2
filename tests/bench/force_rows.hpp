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

/// How good the forces of one sweep were. In newtons.
struct ForceFigures
{
    Spread error_n;             ///< Of the force against the surface's.
    double largest_step_n{0.0}; ///< Of the force from frame to frame.
    /// Frames in which the ball hangs: frozen, without contact, or farther from where it would rest
    /// than `lag_m`.
    std::uint64_t stuck{0};
    std::uint64_t without_force{0}; ///< Frames that press nothing.
};
/// `rests_m` of the counted frames, in the frame of the trace.
[[nodiscard]] ForceFigures measure_forces(const ForceTrace& trace, const std::vector<Vec3>& goals_m,
                                          const std::vector<Vec3>& rests_m, const Touch& touch,
                                          double lag_m);

/// The goals of one sweep; infinite: none.
struct ForceGoals
{
    double frame_p99_us;
    double error_p99_n;
    double error_max_n;
    double step_n;
    bool has_laws{true}; ///< No allocation, no stuck frame.
    double force_p99_us{kNoGoal};
};
/// Within this a proxy that a fast hand left behind is on it again when that slows.
inline constexpr double kReturn_ms = 50.0;

/// `coarser_p99_n` is the same sweep's error on the next coarser mesh, where there is one: the
/// error must be smaller.
void add_force_rows(CaseRows& rows, const ForceTrace& trace, const ForceFigures& figures,
                    const ForceGoals& goals, std::optional<double> coarser_p99_n);

/// Of a sweep whose true force is not known: times, allocations and frames without a force, of
/// which there are to be none.
void add_felt_rows(CaseRows& rows, const ForceTrace& trace, const ForceFigures& figures,
                   const ForceGoals& goals);

/// How far behind a fast hand the proxy is, and what that costs. From the counted frame `slows_at`
/// on, each of 1 ms, the hand is slow: kReturn_ms later the proxy is to be on it again.
void add_lag_rows(CaseRows& rows, const ForceTrace& trace, std::size_t slows_at);

/// What was recorded of CHAI3D 3.3's finger proxy: elsewhere, on a surface of the same kind whose
/// constants were not kept; for the order of magnitude.
void add_recorded_peer(Rows& rows);

} // namespace tactus::bench
