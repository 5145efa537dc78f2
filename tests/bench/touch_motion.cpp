// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/touch_motion.hpp"

#include "tests/bench/bench_row.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/surface_slide.hpp"

namespace tactus::bench
{

namespace
{

constexpr double kTurn_rad_per_s = 3.0;
constexpr double kFlight_diag = 0.62;
constexpr double kFlight_diag_per_s = 2.0;
constexpr double kTouch_diag_per_s = 0.1;

double smoothstep(double t)
{
    return t * t * (3.0 - 2.0 * t);
}

/// Straight motion to `to` with a smooth start and end.
void move(std::vector<Vec3>& path, const Vec3& from, const Vec3& to, std::uint32_t frames)
{
    for (std::uint32_t i = 1; i <= frames; ++i)
    {
        path.emplace_back(from + smoothstep(static_cast<double>(i) / frames) * (to - from));
    }
}

/// Start of a slide that is reached from `from`.
Vec3 slide_start(const TouchScene& scene, const Vec3& from)
{
    const test::FaceTree::Nearest nearest = scene.tree.nearest(from);
    const Vec3 normal = (from - nearest.point_m).normalized();
    return nearest.point_m +
           test::SurfaceSlide::wanted_distance_diag(kRadius_diag, 0) * scene.diagonal_m * normal;
}

void slide(std::vector<Vec3>& path, const TouchScene& scene, double speed_diag_per_s,
           std::uint32_t frames)
{
    test::SlideManner manner;
    manner.diagonal_m = scene.diagonal_m;
    manner.radius_diag = kRadius_diag;
    manner.step_m = speed_diag_per_s * scene.diagonal_m * kPeriod_s;
    manner.rotation_rad = kTurn_rad_per_s * kPeriod_s;
    manner.rotation_rate = [](std::uint64_t turn) { return test::signed_unit(kSeed, turn); };
    test::SurfaceSlide slide(scene.tree, manner, path.back());
    for (std::uint32_t i = 0; i < frames; ++i)
    {
        path.push_back(slide.next());
    }
}

void fly(std::vector<Vec3>& path, const TouchScene& scene, const Vec3& middle, std::uint64_t cycle)
{
    const double radius_m = kFlight_diag * scene.diagonal_m;
    Vec3 outward = (path.back() - middle).normalized();
    const Vec3 request(test::signed_unit(kSeed + 1, 3 * cycle),
                       test::signed_unit(kSeed + 1, 3 * cycle + 1),
                       test::signed_unit(kSeed + 1, 3 * cycle + 2));
    Vec3 heading = test::tangent(request, outward);
    for (std::uint32_t i = 0; i < kFlightFrames; ++i)
    {
        outward = (outward + kFlight_diag_per_s * kPeriod_s / kFlight_diag * heading).normalized();
        heading = test::tangent(heading, outward);
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
