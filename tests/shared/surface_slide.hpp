// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "tests/shared/face_tree.hpp"

#include <cstdint>
#include <functional>

namespace tactus::test
{

/// `direction` without its component along the unit vector `normal`, normalised.
[[nodiscard]] Vec3 tangent(const Vec3& direction, const Vec3& normal);

/// Parameters of a slide; shares of the diagonal refer to `diagonal_m`.
struct SlideManner
{
    double diagonal_m{0.0};
    double radius_diag{0.01};
    double step_m{0.0};           ///< Step of a frame.
    double rotation_rad{3.0e-3};  ///< Greatest rotation of the heading in a frame.
    std::uint32_t first_frame{0}; ///< Start within the turns and swings.
    /// Rate of each turn of kTurnFrames, in -1 .. 1.
    std::function<double(std::uint64_t turn)> rotation_rate;
};

/// Centre of a probe that slides along a true surface: each step follows a rotating heading, then
/// moves to the wanted distance from the nearest surface point. That distance is the radius plus a
/// depth that swings between -0.3 % and +0.2 % of the diagonal in kSwingFrames. Computed from the
/// mesh alone, independent of the tested or measured code.
class SurfaceSlide
{
public:
    static constexpr std::uint32_t kTurnFrames = 400; ///< Frames between two rates of the heading.
    static constexpr std::uint32_t kSwingFrames = 1'000;

    /// Starts at a place near the surface with a heading along x, projected to the surface.
    SurfaceSlide(const FaceTree& tree, SlideManner manner, const Vec3& start_m);

    Vec3 next();

    /// Distance of the probe's centre from the surface in a frame of a slide, as a share of the
    /// diagonal; greatest in frame 0.
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
