// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/simulated/landing_sites.hpp"
#include "platform/devices/simulated/operator_motions.hpp"
#include "platform/devices/simulated/simulated_device.hpp"
#include "tests/shared/period.hpp"
#include "tests/unit/platform/fake_wall.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace tactus
{
namespace
{

using test::kPeriod_s;

constexpr double kDiagonal_m = 0.2;
constexpr double kRadius_m = 0.0577;
constexpr double kTool_m = 0.01 * kDiagonal_m;

const std::pair<const char*, MotionKind> kKinds[] = {{"script", MotionKind::script},
                                                     {"free", MotionKind::free},
                                                     {"approach", MotionKind::approach},
                                                     {"slide", MotionKind::slide},
                                                     {"tap", MotionKind::tap},
                                                     {"teleport", MotionKind::teleport},
                                                     {"spin", MotionKind::spin},
                                                     {"tremor", MotionKind::tremor},
                                                     {"turn", MotionKind::turn},
                                                     {"edge", MotionKind::edge},
                                                     {"peg", MotionKind::peg}};

/// Scene of a sphere, for `frames` frames at 1 kHz.
OperatorScene scene_of(std::uint64_t frames)
{
    OperatorScene scene;
    for (int axis = 0; axis < 3; ++axis)
    {
        scene.anchors_world_m.push_back(Vec3::Unit(axis) * kRadius_m);
        scene.anchors_world_m.push_back(Vec3::Unit(axis) * -kRadius_m);
    }
    scene.diagonal_m = kDiagonal_m;
    scene.tool_radius_m = kTool_m;
    scene.period = milliseconds(1);
    scene.frames_total = frames;
    return scene;
}

MadeMotion make(MotionKind kind, std::uint64_t frames, std::uint64_t seed = 1)
{
    return std::move(make_motion(kind, scene_of(frames), seed)).value();
}

double nothing(const Vec3& /*place*/)
{
    return 1.0;
}

/// Block with a hole from above.
constexpr double kHole_m = 0.01;
constexpr double kHoleBottom_m = 0.01;
constexpr double kHoleTop_m = 0.05;
double block_with_a_hole(const Vec3& p)
{
    const double to_wall_m = kHole_m - p.head<2>().norm();
    const double over_m = p.z() - kHoleTop_m;
    if (over_m > 0.0)
    {
        return to_wall_m > 0.0 ? std::hypot(to_wall_m, over_m) : over_m;
    }
    return to_wall_m > 0.0 ? std::min(to_wall_m, p.z() - kHoleBottom_m)
                           : std::max(to_wall_m, over_m);
}

/// Default device in that hand, on a sphere of 500 N/m or another shape. With a drag its force also
/// damps the motion, as a force does that returns after a fault.
struct Play
{
    std::vector<Vec3> device_m;
    std::vector<double> force_n;
    std::vector<Vec3> normal; ///< Normals of the touched walls, or zero.
    std::vector<Mat3> rotation;
    std::vector<DeviceSample> samples;

    explicit Play(MotionKind kind, std::uint64_t frames = 4'000,
                  const test::Shape& shape = test::sphere(kRadius_m), double drag_n_s_per_m = 0.0)
    {
        MadeMotion motion = make(kind, frames);
        SimulatedDeviceOptions options;
        options.workspace_centre_world_m = motion.centre_world_m;
        options.workspace_radius_m = motion.reach_m;
        test::FakeWall wall(shape, 500.0, kTool_m, motion.motion->start_world_m());
        auto device = std::move(SimulatedDevice::create(options, std::move(motion.motion))).value();
        for (std::uint64_t frame = 0; frame < frames; ++frame)
        {
            const DeviceSample sample = device->read();
            const auto& p = sample.position_world_m;
            const auto& v = *sample.velocity_world_m_per_s;
            const Vec3 force = wall.respond(Vec3(p[0], p[1], p[2]));
            const Vec3 felt = force - drag_n_s_per_m * Vec3(v[0], v[1], v[2]);
            device->write({{felt.x(), felt.y(), felt.z()}, {}, 0.0});
            device_m.emplace_back(p[0], p[1], p[2]);
            force_n.push_back(force.norm());
            normal.push_back(force.norm() > 0.0 ? Vec3(force.normalized()) : Vec3(0.0, 0.0, 0.0));
            rotation.push_back(to_rotation(*sample.rotation_world));
            samples.push_back(sample);
        }
    }

    /// Share of frames in contact from `from` on.
    [[nodiscard]] double contact_share(std::size_t from = 0) const
    {
        const auto touching = std::count_if(force_n.begin() + static_cast<std::ptrdiff_t>(from),
                                            force_n.end(), [](double n) { return n > 0.0; });
        return static_cast<double>(touching) / static_cast<double>(force_n.size() - from);
    }
    /// Number of times that the surface was reached.
    [[nodiscard]] int landings() const
    {
        int landings = 0;
        for (std::size_t i = 1; i < force_n.size(); ++i)
        {
            landings += force_n[i] > 0.0 && force_n[i - 1] == 0.0 ? 1 : 0;
        }
        return landings;
    }
};

TEST(OperatorMotions, are_found_by_their_names_and_by_no_others)
{
    for (const auto& [name, kind] : kKinds)
    {
        EXPECT_EQ(motion_named(name), kind);
        EXPECT_NE(kMotionNames.find(name), std::string_view::npos);
    }
    for (const char* name : {"", "Free", "free ", "fly"})
    {
        EXPECT_FALSE(motion_named(name).has_value()) << name;
    }
}

TEST(OperatorMotions, repeat_bit_for_bit_and_stay_finite_on_a_model_that_is_not_there)
{
    for (const auto& [name, kind] : kKinds)
    {
        const Play one(kind, 2'000);
        const Play two(kind, 2'000);
        const Play lost(kind, 6'000, nothing);
        EXPECT_TRUE(one.device_m == two.device_m && one.rotation == two.rotation) << name;
        EXPECT_EQ(lost.contact_share(), 0.0) << name;
        EXPECT_TRUE(std::ranges::all_of(lost.device_m,
                                        [](const Vec3& p) { return p.norm() < 3.0 * kDiagonal_m; }))
            << name;
    }
}

TEST(OperatorMotions, refuse_a_scene_that_cannot_be_played)
{
    for (const auto& [name, kind] : kKinds)
    {
        OperatorScene scene = scene_of(100);
        scene.tool_radius_m = 0.0;
        const auto made = make_motion(kind, scene);
        ASSERT_FALSE(made) << name;
        EXPECT_NE(made.error().text.find("tool radius"), std::string::npos);
    }
}

TEST(OperatorMotions, free_goes_round_the_model_without_touching_it)
{
    const Play run(MotionKind::free, 4'000);
    EXPECT_EQ(run.contact_share(), 0.0);
    Vec3 low = run.device_m.front();
    Vec3 high = low;
    for (const Vec3& p : run.device_m)
    {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    EXPECT_GT((high - low).norm(), 1.3 * kDiagonal_m); // One round in 4 s.
    EXPECT_LT((run.device_m.back() - run.device_m.front()).norm(), 0.1 * kDiagonal_m);
}

TEST(OperatorMotions, approach_comes_to_rest_with_about_a_newton)
{
    const Play run(MotionKind::approach);
    EXPECT_EQ(run.landings(), 1);
    EXPECT_EQ(run.contact_share(3'000), 1.0);
    EXPECT_NEAR(run.force_n.back(), 1.0, 0.2);
    EXPECT_LT((run.device_m.back() - run.device_m[3'000]).norm(), 1e-6);
}

TEST(OperatorMotions, are_not_taken_in_by_a_force_that_damps_in_the_air)
{
    for (const MotionKind kind : {MotionKind::approach, MotionKind::tap, MotionKind::spin})
    {
        const Play run(kind, 4'000, test::sphere(kRadius_m), 1.0);
        EXPECT_GT(run.contact_share(2'000), 0.2) << static_cast<int>(kind);
        EXPECT_GT(*std::ranges::max_element(run.force_n), 0.7) << static_cast<int>(kind);
    }
}

TEST(OperatorMotions, slide_stays_on_the_surface)
{
    const Play run(MotionKind::slide);
    const Play script(MotionKind::script);
    EXPECT_GT(run.contact_share(), script.contact_share());
    EXPECT_EQ(run.landings(), 1);
    EXPECT_GE(script.landings(), 4);
}

TEST(OperatorMotions, tap_meets_and_leaves_the_surface_twice_a_second)
{
    const Play run(MotionKind::tap, 5'000);
    EXPECT_GE(run.landings(), 8);
    EXPECT_LE(run.landings(), 10);
    EXPECT_GT(run.contact_share(1'000), 0.2);
    EXPECT_LT(run.contact_share(1'000), 0.8);
    EXPECT_LT(*std::ranges::max_element(run.force_n), 4.0);
}

TEST(OperatorMotions, spin_circles_in_contact)
{
    const Play run(MotionKind::spin, 5'000);
    EXPECT_GT(run.contact_share(2'000), 0.95);
    Vec3 middle = Vec3::Zero();
    for (std::size_t i = 3'000; i < 5'000; ++i)
    {
        middle += run.device_m[i] / 2'000.0;
    }
    double turned_rad = 0.0;
    for (std::size_t i = 3'001; i < 5'000; ++i)
    {
        const Vec3 a = run.device_m[i - 1] - middle;
        const Vec3 b = run.device_m[i] - middle;
        turned_rad += std::asin(std::min(a.cross(b).norm() / (a.norm() * b.norm()), 1.0));
        EXPECT_NEAR(b.norm(), 0.05 * kDiagonal_m, 0.03 * kDiagonal_m);
    }
    EXPECT_NEAR(turned_rad, 4.0 * 2.0 * std::numbers::pi, 0.5);
}

TEST(OperatorMotions, turn_turns_the_tool_in_touch_about_one_axis_after_the_other)
{
    const Play run(MotionKind::turn, 8'000);
    EXPECT_EQ(run.landings(), 1);
    EXPECT_EQ(run.contact_share(2'000), 1.0);
    Vec3 farthest(0.0, 0.0, 0.0);
    for (std::size_t i = 0; i < run.rotation.size(); ++i)
    {
        const Vec3 turn = rotation_vector(orthonormalised(run.rotation[i])).cwiseAbs();
        farthest = farthest.cwiseMax(turn);
        // The wrist rests between two swings.
        EXPECT_LT(turn.norm() - turn.maxCoeff(), 0.02) << i;
        EXPECT_TRUE(run.force_n[i] > 0.0 || turn.norm() < 0.05) << i;
    }
    for (const double angle : farthest)
    {
        EXPECT_NEAR(angle, std::numbers::pi / 6.0, 0.08);
    }
}

TEST(OperatorMotions, edge_turns_the_tool_with_the_surface_round_a_sphere_and_over_edges)
{
    const auto turned_from_first_touch = [](const Play& run, double& slips_rad)
    {
        const auto first = static_cast<std::size_t>(
            std::distance(run.force_n.begin(),
                          std::ranges::find_if(run.force_n, [](double n) { return n > 0; })));
        const Vec3 stood = run.rotation[first].transpose() * run.normal[first];
        double farthest_rad = 0.0;
        for (std::size_t i = first + 500; i < run.rotation.size(); ++i)
        {
            if (run.force_n[i] > 0.1)
            {
                const Vec3 up = run.rotation[i] * stood;
                slips_rad = std::max(slips_rad, up.cross(run.normal[i]).norm());
                farthest_rad = std::max(farthest_rad,
                                        rotation_vector(orthonormalised(run.rotation[i])).norm());
            }
        }
        return farthest_rad;
    };
    double slips_rad = 0.0;
    const Play sphere(MotionKind::edge, 6'000);
    EXPECT_GT(turned_from_first_touch(sphere, slips_rad), 0.5);
    EXPECT_LT(slips_rad, 0.15);
    const Play bar(MotionKind::edge, 8'000,
                   test::box(Vec3(0.0, 0.0, 0.0), Vec3(kRadius_m, 0.02, 0.02)));
    EXPECT_GT(turned_from_first_touch(bar, slips_rad), 1.2);
    EXPECT_GT(bar.contact_share(1'000), 0.6);
}

TEST(OperatorMotions, peg_goes_into_a_hole_and_changes_its_grip_outside_of_it)
{
    const Play run(MotionKind::peg, 11'500, block_with_a_hole);
    EXPECT_EQ(run.samples.front().gripper_m, 0.02);
    double lowest_m = 1.0;
    int grips = 0;
    Vec3 farthest(0.0, 0.0, 0.0);
    for (std::size_t i = 0; i < run.samples.size(); ++i)
    {
        lowest_m = std::min(lowest_m, run.device_m[i].z());
        EXPECT_LT(run.device_m[i].head<2>().norm(), kHole_m);
        const DeviceSample& now = run.samples[i];
        EXPECT_TRUE(now.buttons == 1U || (now.buttons == 0U && now.gripper_m == 0.02)) << i;
        EXPECT_TRUE(now.buttons == 0U || run.force_n[i] == 0.0) << i;
        grips += i > 0 && now.buttons > run.samples[i - 1].buttons ? 1 : 0;
        farthest = farthest.cwiseMax(rotation_vector(orthonormalised(run.rotation[i])).cwiseAbs());
    }
    // The tool is a sphere of 2 mm, and 1 N on 500 N/m is 2 mm more.
    EXPECT_NEAR(lowest_m, kHoleBottom_m + kTool_m - 0.002, 1e-3);
    EXPECT_EQ(grips, 2);
    EXPECT_EQ(run.landings(), 2);
    EXPECT_NEAR(*std::ranges::max_element(run.force_n), 1.0, 0.3);
    EXPECT_NEAR(
        *std::ranges::max_element(run.samples, {}, [](const auto& s) { return *s.gripper_m; })
             ->gripper_m,
        0.05, 1e-4);
    EXPECT_NEAR(farthest.x(), 0.035, 0.01);
    EXPECT_NEAR(farthest.y(), 0.035, 0.01);
    EXPECT_LT(farthest.z(), 1e-3);
}

TEST(OperatorMotions, teleport_is_at_places_of_the_model_and_jumps_between_them)
{
    const auto places_of = [](std::uint64_t seed)
    {
        const MadeMotion sut = make(MotionKind::teleport, 10'000, seed);
        std::vector<Vec3> places{sut.motion->start_world_m()};
        for (std::uint64_t frame = 1; frame < 10'000; ++frame)
        {
            const Vec3 place = sut.motion->next_world_m({frame, Vec3::Zero(), Vec3::Zero()});
            if (place != places.back())
            {
                places.push_back(place);
            }
        }
        return places;
    };
    const std::vector<Vec3> places = places_of(1);
    EXPECT_GT(places.size(), 15U); // The hand sometimes stays in place.
    EXPECT_LE(places.size(), 20U);
    const std::vector<LandingSite> sites =
        find_landing_sites(scene_of(1).anchors_world_m, kDiagonal_m, kTool_m);
    for (const Vec3& place : places)
    {
        EXPECT_TRUE(std::ranges::any_of(
            sites, [&](const LandingSite& site)
            { return site.aim_world_m == place || site.gate_world_m == place; }));
    }
    // Later hands begin at others of the same places.
    std::vector<LandingSite> turned =
        find_landing_sites(scene_of(1).anchors_world_m, kDiagonal_m, kTool_m, 7);
    EXPECT_EQ(turned.size(), sites.size());
    EXPECT_EQ(turned.front().gate_world_m, sites[2].gate_world_m); // 6 pairs of them.
    EXPECT_TRUE(places == places_of(1));
    EXPECT_FALSE(places == places_of(2));
}

/// Share of a signal's power at these frequencies, by the definition of the transform.
double power_between(const std::vector<double>& signal, double low_hz, double high_hz)
{
    const auto count = static_cast<double>(signal.size());
    double sum = 0.0;
    double squares = 0.0;
    for (const double value : signal)
    {
        squares += value * value;
    }
    for (double turns = low_hz * count * kPeriod_s; turns <= high_hz * count * kPeriod_s; ++turns)
    {
        double re = 0.0;
        double im = 0.0;
        for (std::size_t i = 0; i < signal.size(); ++i)
        {
            const double angle = 2.0 * std::numbers::pi * turns * static_cast<double>(i) / count;
            re += signal[i] * std::cos(angle);
            im += signal[i] * std::sin(angle);
        }
        sum += 2.0 * (re * re + im * im) / count;
    }
    return sum / squares;
}

TEST(OperatorMotions, tremor_is_the_script_with_swings_of_8_to_12_hz_by_its_seed)
{
    constexpr std::uint64_t kFrames = 4'000;
    const MadeMotion plain = make(MotionKind::script, kFrames);
    const MadeMotion one = make(MotionKind::tremor, kFrames);
    const MadeMotion other = make(MotionKind::tremor, kFrames, 2);
    EXPECT_EQ(one.motion->start_world_m(), plain.motion->start_world_m());
    std::array<std::vector<double>, 3> tremor_m;
    bool has_own_seed = false;
    for (std::uint64_t frame = 1; frame <= kFrames; ++frame)
    {
        const OperatorSense sense{frame, Vec3::Zero(), Vec3::Zero()};
        const Vec3 still_m = plain.motion->next_world_m(sense);
        const Vec3 difference_m = one.motion->next_world_m(sense) - still_m;
        has_own_seed |= other.motion->next_world_m(sense) - still_m != difference_m;
        for (int axis = 0; axis < 3; ++axis)
        {
            tremor_m[static_cast<std::size_t>(axis)].push_back(difference_m[axis]);
            EXPECT_LE(std::abs(difference_m[axis]), 6.1e-4);
        }
    }
    EXPECT_TRUE(has_own_seed);
    for (const std::vector<double>& signal : tremor_m)
    {
        EXPECT_GT(*std::ranges::max_element(signal), 1e-4);
        EXPECT_GT(power_between(signal, 7.0, 13.0), 0.97);
    }
}

} // namespace
} // namespace tactus
