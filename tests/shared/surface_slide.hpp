// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "tests/shared/face_tree.hpp"

#include <cstdint>
#include <functional>

namespace tactus::test
{

/// `direction` without its part along the unit vector `normal`, of length 1.
[[nodiscard]] Vec3 tangent(const Vec3& direction, const Vec3& normal);

/// How a probe slides. Shares of the diagonal are of `diagonal_m`.
struct SlideManner
{
    double diagonal_m{0.0};
    double radius_diag{0.01};     ///< Of the probe.
    double step_m{0.0};           ///< A frame.
    double turn_rad{3.0e-3};      ///< At most, a frame.
    std::uint32_t first_frame{0}; ///< Where it begins in its turns and swings.
    /// In -1 .. 1 for each turn of kTurnFrames: how fast it turns then.
    std::function<double(std::uint64_t turn)> turn_rate;
};

/// The centre of a probe that slides along a true surface: each step goes along a heading that
/// turns, then to the wanted distance from the surface's nearest point. The wanted distance is the
/// radius plus a depth that swings between -0.3 % and +0.2 % of the diagonal in kSwingFrames.
/// Computed from the mesh alone; nothing that is tested or measured takes part.
class SurfaceSlide
{
public:
    static constexpr std::uint32_t kTurnFrames = 400; ///< From one rate of turning to the next.
    static constexpr std::uint32_t kSwingFrames = 1'000;

    /// Starts at a place near the surface, heading along x as far as the surface lets it.
    SurfaceSlide(const FaceTree& tree, SlideManner manner, const Vec3& start_m);

    Vec3 next();

    /// Distance of the probe's centre from the surface in a frame of a slide, as a share of the
    /// diagonal; highest in frame 0.
    [[nodiscard]] static double wanted_distance_diag(double radius_diag, std::uint32_t frame);

private:
    const FaceTree& tree_;
    SlideManner manner_;
    Vec3 center_;
    Vec3 normal_;
    Vec3 heading_;
    std::uint32_t frame_{0};
};

} // namespace tactus::test
