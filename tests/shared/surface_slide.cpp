// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/surface_slide.hpp"

#include <Eigen/Geometry>

#include <utility>

namespace tactus::test
{

namespace
{

constexpr double kDeepest_diag = -0.003;
constexpr double kHighest_diag = 0.002;

double smoothstep(double t)
{
    return t * t * (3.0 - 2.0 * t);
}

/// Direction away from the surface; on it the previous one.
Vec3 normal_at(const Vec3& center, const Vec3& foot, const Vec3& before)
{
    return center == foot ? before : (center - foot).normalized();
}

} // namespace

Vec3 tangent(const Vec3& direction, const Vec3& normal)
{
    const Vec3 flat = direction - direction.dot(normal) * normal;
    return flat.norm() > 1e-9 ? flat.normalized() : normal.unitOrthogonal();
}

SurfaceSlide::SurfaceSlide(const FaceTree& tree, SlideManner manner, const Vec3& start_m)
    : tree_(tree)
    , manner_(std::move(manner))
    , center_(start_m)
    , normal_(normal_at(start_m, tree.nearest(start_m).point_m, Vec3(0.0, 0.0, 1.0)))
    , heading_(tangent(Vec3(1.0, 0.0, 0.0), normal_))
    , frame_(manner_.first_frame)
{
}

double SurfaceSlide::wanted_distance_diag(double radius_diag, std::uint32_t frame)
{
    const double phase = static_cast<double>(frame % kSwingFrames) / kSwingFrames;
    const double height = smoothstep(phase < 0.5 ? 1.0 - 2.0 * phase : 2.0 * phase - 1.0);
    return radius_diag + kDeepest_diag + (kHighest_diag - kDeepest_diag) * height;
}

Vec3 SurfaceSlide::next()
{
    const double mix = static_cast<double>(frame_ % kTurnFrames) / kTurnFrames;
    const std::uint64_t turn = frame_ / kTurnFrames;
    const double rate =
        (1.0 - mix) * manner_.rotation_rate(turn) + mix * manner_.rotation_rate(turn + 1);
    heading_ = tangent(heading_ + manner_.rotation_rad * rate * normal_.cross(heading_), normal_);
    center_ += manner_.step_m * heading_;
    const Vec3 foot = tree_.nearest(center_).point_m;
    normal_ = normal_at(center_, foot, normal_);
    ++frame_;
    center_ =
        foot + wanted_distance_diag(manner_.radius_diag, frame_) * manner_.diagonal_m * normal_;
    return center_;
}

} // namespace tactus::test
