// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/touch_motion.hpp"

#include "tests/bench/random.hpp"

#include <Eigen/Geometry>

#include <algorithm>

namespace tactus::bench
{

namespace
{

constexpr double kTurn_rad_per_s = 3.0;
constexpr std::uint32_t kTurnFrames = 400; ///< From one rate of turning to the next.
constexpr std::uint32_t kSwingFrames = 1'000;
constexpr double kDeepest_diag = -0.003;
constexpr double kHighest_diag = 0.002;
constexpr double kFlight_diag = 0.62;
constexpr double kFlight_diag_per_s = 2.0;
constexpr double kTouch_diag_per_s = 0.1;

double smoothstep(double t)
{
    return t * t * (3.0 - 2.0 * t);
}

/// `direction` without its part along the unit vector `normal`, of length 1.
Vec3 tangent(const Vec3& direction, const Vec3& normal)
{
    const Vec3 flat = direction - direction.dot(normal) * normal;
    return flat.norm() > 1e-9 ? flat.normalized() : normal.unitOrthogonal();
}

/// Distance of the probe's centre from the surface in this frame of a slide; highest at first.
double wanted_distance_diag(std::uint32_t frame)
{
    const double phase = static_cast<double>(frame % kSwingFrames) / kSwingFrames;
    const double height = smoothstep(phase < 0.5 ? 1.0 - 2.0 * phase : 2.0 * phase - 1.0);
    return kRadius_diag + kDeepest_diag + (kHighest_diag - kDeepest_diag) * height;
}

/// Straight, gently at both ends; ends at `to`.
void move(std::vector<Vec3>& path, const Vec3& from, const Vec3& to, std::uint32_t frames)
{
    for (std::uint32_t i = 1; i <= frames; ++i)
    {
        path.emplace_back(from + smoothstep(static_cast<double>(i) / frames) * (to - from));
    }
}

/// Where a slide begins that is reached from `from`.
Vec3 slide_start(const TouchScene& scene, const Vec3& from)
{
    const test::FaceTree::Nearest nearest = scene.tree.nearest(from);
    const Vec3 normal = (from - nearest.point_m).normalized();
    return nearest.point_m + wanted_distance_diag(0) * scene.diagonal_m * normal;
}

void slide(std::vector<Vec3>& path, const TouchScene& scene, double speed_diag_per_s,
           std::uint32_t frames)
{
    Vec3 center = path.back();
    Vec3 normal = (center - scene.tree.nearest(center).point_m).normalized();
    Vec3 heading = tangent(Vec3(1.0, 0.0, 0.0), normal);
    for (std::uint32_t i = 0; i < frames; ++i)
    {
        const double mix = static_cast<double>(i % kTurnFrames) / kTurnFrames;
        const double rate = (1.0 - mix) * signed_unit(kSeed, i / kTurnFrames) +
                            mix * signed_unit(kSeed, i / kTurnFrames + 1);
        const double turn = kTurn_rad_per_s * kPeriod_s * rate;
        heading = tangent(heading + turn * normal.cross(heading), normal);
        center += speed_diag_per_s * scene.diagonal_m * kPeriod_s * heading;
        const Vec3 foot = scene.tree.nearest(center).point_m;
        normal = (center - foot).normalized();
        center = foot + wanted_distance_diag(i + 1) * scene.diagonal_m * normal;
        path.push_back(center);
    }
}

void fly(std::vector<Vec3>& path, const TouchScene& scene, const Vec3& middle, std::uint64_t cycle)
{
    const double radius_m = kFlight_diag * scene.diagonal_m;
    Vec3 outward = (path.back() - middle).normalized();
    const Vec3 wish(signed_unit(kSeed + 1, 3 * cycle), signed_unit(kSeed + 1, 3 * cycle + 1),
                    signed_unit(kSeed + 1, 3 * cycle + 2));
    Vec3 heading = tangent(wish, outward);
    for (std::uint32_t i = 0; i < kFlightFrames; ++i)
    {
        outward = (outward + kFlight_diag_per_s * kPeriod_s / kFlight_diag * heading).normalized();
        heading = tangent(heading, outward);
        path.emplace_back(middle + radius_m * outward);
    }
}

} // namespace

std::vector<Vec3> slide_motion(const TouchScene& scene, double speed_diag_per_s,
                               std::uint32_t frames)
{
    const Vec3 middle = 0.5 * (scene.tree.low_m() + scene.tree.high_m());
    const Vec3 above(middle.x(), middle.y(), scene.tree.high_m().z() + 0.05 * scene.diagonal_m);
    std::vector<Vec3> path;
    move(path, above, slide_start(scene, above), kApproachFrames);
    slide(path, scene, speed_diag_per_s, frames);
    return path;
}

std::vector<Vec3> touch_motion(const TouchScene& scene, std::uint32_t frames)
{
    const Vec3 middle = 0.5 * (scene.tree.low_m() + scene.tree.high_m());
    const double flight_m = kFlight_diag * scene.diagonal_m;
    std::vector<Vec3> path{middle + Vec3(0.0, 0.0, flight_m)};
    for (std::uint64_t cycle = 0; path.size() <= frames; ++cycle)
    {
        fly(path, scene, middle, cycle);
        const Vec3 above = path.back();
        move(path, above, slide_start(scene, above), kApproachFrames);
        slide(path, scene, kTouch_diag_per_s, kTouchFrames);
        const Vec3 below = path.back();
        move(path, below, middle + flight_m * (below - middle).normalized(), kRetreatFrames);
    }
    return {path.begin() + 1, path.begin() + 1 + frames};
}

} // namespace tactus::bench
