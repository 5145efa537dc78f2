// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "tests/shared/face_tree.hpp"

#include <cstdint>
#include <vector>

namespace tactus::bench
{

/// Probe and mesh; all lengths of the motions are shares of the diagonal.
struct TouchScene
{
    const test::FaceTree& tree;
    double diagonal_m{0.0};
};

inline constexpr double kPeriod_s = 1e-3;
/// Radius of the probe, as a share of the diagonal.
inline constexpr double kRadius_diag = 0.01;
/// Frames of the descent to the surface before a slide counts.
inline constexpr std::uint32_t kApproachFrames = 300;
/// Frames of one cycle of the touching motion: flight, approach, slide, retreat.
inline constexpr std::uint32_t kFlightFrames = 400;
inline constexpr std::uint32_t kTouchFrames = 1'500;
inline constexpr std::uint32_t kRetreatFrames = 300;
inline constexpr std::uint32_t kCycleFrames =
    kFlightFrames + kApproachFrames + kTouchFrames + kRetreatFrames;

/// Centres of a probe that descends to the highest point for kApproachFrames and then slides along
/// the true surface for `frames` at a speed. Each step follows a heading that changes by up to 3
/// rad/s, then moves to the wanted distance from the nearest surface point. That distance is the
/// radius plus a depth that swings between -0.3 % and +0.2 % of the diagonal once a second.
/// Computed from the mesh alone, independent of the measured code.
[[nodiscard]] std::vector<Vec3> slide_motion(const TouchScene& scene, double speed_diag_per_s,
                                             std::uint32_t frames);

/// `frames` centres in cycles of 2.5 s: flight around the object at 2 diag/s and 0.62 diag from its
/// centre, approach to the nearest point, slide at 0.1 diag/s, retreat.
[[nodiscard]] std::vector<Vec3> touch_motion(const TouchScene& scene, std::uint32_t frames);

} // namespace tactus::bench
