// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/devices/device_force.hpp"
#include "platform/devices/simulated/scripted_operator.hpp"
#include "platform/devices/simulated/simulated_device.hpp"
#include "platform/machine/allocation_counter.hpp"
#include "tests/unit/platform/fake_wall.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <ostream>

namespace tactus
{
namespace
{

constexpr double kDiagonalM = 0.2;
constexpr double kToolRadiusM = 0.01 * kDiagonalM;

struct Model
{
    std::string name;
    test::Shape shape;
    std::vector<Vec3> anchors;
};

void PrintTo(const Model& model, std::ostream* out)
{
    *out << model.name;
}

std::vector<Vec3> corners(const Vec3& centre, const Vec3& half)
{
    std::vector<Vec3> points;
    for (const double x : {-1.0, 1.0})
    {
        for (const double y : {-1.0, 1.0})
        {
            for (const double z : {-1.0, 1.0})
            {
                points.push_back(centre + half.cwiseProduct(Vec3(x, y, z)));
            }
        }
    }
    return points;
}

Model sphere_model()
{
    const double radius_m = 0.0577;
    std::vector<Vec3> anchors;
    for (int axis = 0; axis < 3; ++axis)
    {
        anchors.push_back(Vec3::Unit(axis) * radius_m);
        anchors.push_back(Vec3::Unit(axis) * -radius_m);
    }
    return {"sphere", test::sphere(radius_m), anchors};
}

/// Strip so narrow that the hand slides over its edges.
Model strip_model()
{
    const Vec3 half(0.1, 0.006, 0.003);
    return {"strip", test::box(Vec3::Zero(), half), corners(Vec3::Zero(), half)};
}

Model l_model()
{
    const Vec3 foot(0.06, 0.05, 0.012);
    const Vec3 wall(0.012, 0.05, 0.05);
    const Vec3 wall_centre(-0.048, 0.0, 0.05);
    std::vector<Vec3> anchors = corners(Vec3::Zero(), foot);
    const std::vector<Vec3> more = corners(wall_centre, wall);
    anchors.insert(anchors.end(), more.begin(), more.end());
    return {"L", test::join(test::box(Vec3::Zero(), foot), test::box(wall_centre, wall)), anchors};
}

struct Recording
{
    std::vector<Vec3> device;
    std::vector<double> force_n;
    std::vector<OperatorPhase> phase;
    std::uint64_t forces_clamped{0};
    std::uint64_t heap_calls{0};

    [[nodiscard]] double contact_share() const
    {
        const auto touching =
            std::count_if(force_n.begin(), force_n.end(), [](double force) { return force > 0.0; });
        return static_cast<double>(touching) / static_cast<double>(force_n.size());
    }
};

/// Force at the device from the wall's force in that frame, at that velocity.
using ForceLaw = std::function<Vec3(std::uint64_t frame, const Vec3& wall_n, const Vec3& velocity)>;

Vec3 all_of_it(std::uint64_t /*frame*/, const Vec3& wall_n, const Vec3& /*velocity*/)
{
    return wall_n;
}

/// ForceFader's law: five times a second the force fades within 50 ms, with damping also in the
/// air, and returns within 100 ms.
Vec3 cut_and_damped(std::uint64_t frame, const Vec3& wall_n, const Vec3& velocity)
{
    constexpr double kDamping_n_s_per_m = 0.5;
    const double since_s = 1e-3 * static_cast<double>(frame % 200);
    const double fading = std::max(1.0 - since_s / 0.05, 0.0);
    const double rising = std::clamp((since_s - 0.06) / 0.1, 0.0, 1.0);
    return (fading + rising) * wall_n -
           4.0 * fading * (1.0 - fading) * kDamping_n_s_per_m * velocity;
}

Recording play(const Model& model, double seconds, std::int64_t rate_hz = 1'000,
               double stiffness = 500.0, const ForceLaw& law = all_of_it)
{
    const auto frames = static_cast<std::uint64_t>(seconds * static_cast<double>(rate_hz));
    auto hand = std::move(ScriptedOperator::create({model.anchors, kDiagonalM, kToolRadiusM,
                                                    nanoseconds(1'000'000'000 / rate_hz), frames}))
                    .value();
    const ScriptedOperator& script = *hand;
    SimulatedDeviceOptions options;
    options.rate_hz = rate_hz;
    options.workspace_centre_world_m = script.centre_world_m();
    options.workspace_radius_m = script.reach_m();
    test::FakeWall wall(model.shape, stiffness, kToolRadiusM, script.start_world_m());
    auto device = std::move(SimulatedDevice::create(options, std::move(hand))).value();
    Recording run;
    for (std::uint64_t frame = 0; frame < frames; ++frame)
    {
        const auto before = allocation_counter::of_this_thread();
        allocation_counter::mark_this_thread(true);
        const DeviceSample sample = device->read();
        const auto& p = sample.position_world_m;
        allocation_counter::mark_this_thread(false);
        run.heap_calls += allocation_counter::of_this_thread().allocations - before.allocations;
        const Vec3 force = wall.respond(Vec3(p[0], p[1], p[2]));
        const auto velocity = sample.velocity_world_m_per_s.value_or(std::array<double, 3>{});
        device->write({to_array(law(frame, force, to_vec3(velocity))), {}, 0.0});
        run.device.emplace_back(p[0], p[1], p[2]);
        run.force_n.push_back(force.norm());
        run.phase.push_back(script.phase());
    }
    run.forces_clamped = device->status().forces_clamped;
    return run;
}

using ScriptedOperatorOnModel = testing::TestWithParam<Model>;

INSTANTIATE_TEST_SUITE_P(Models, ScriptedOperatorOnModel,
                         testing::Values(sphere_model(), strip_model(), l_model()),
                         [](const auto& each) { return each.param.name; });

TEST_P(ScriptedOperatorOnModel, flies_touches_lifts_off_now_and_then_and_retreats)
{
    for (const double seconds : {3.0, 10.0})
    {
        const Recording run = play(GetParam(), seconds);
        EXPECT_EQ(run.phase.front(), OperatorPhase::flight);
        EXPECT_EQ(run.force_n.front(), 0.0);
        EXPECT_EQ(run.phase.back(), OperatorPhase::retreat);
        EXPECT_EQ(run.force_n.back(), 0.0);
        EXPECT_GE(run.contact_share(), 0.65) << seconds << " s";
        EXPECT_EQ(run.forces_clamped, 0U);
        std::uint32_t left = 0;
        for (std::size_t i = 1; i < run.phase.size(); ++i)
        {
            const bool ended =
                run.phase[i - 1] == OperatorPhase::lift && run.phase[i] == OperatorPhase::descend;
            const double clearance_m = GetParam().shape(run.device[i]) - kToolRadiusM;
            left += ended && clearance_m > kToolRadiusM ? 1U : 0U;
        }
        EXPECT_GE(left, 3U) << seconds << " s";
        if (allocation_counter::available())
        {
            EXPECT_EQ(run.heap_calls, 0U);
        }
    }
}

TEST_P(ScriptedOperatorOnModel, touches_stiff_walls_at_high_rates_as_well)
{
    EXPECT_GE(play(GetParam(), 5.0, 10'000, 3'000.0).contact_share(), 0.65);
}

/// The wall stays in contact with and without its force.
TEST_P(ScriptedOperatorOnModel, finds_the_surface_again_when_the_force_is_cut_and_damps_the_air)
{
    EXPECT_GE(play(GetParam(), 10.0, 1'000, 500.0, cut_and_damped).contact_share(), 0.6);
}

TEST(ScriptedOperator, goes_on_to_other_sites_when_the_first_is_empty)
{
    // Half of the anchors float in empty space, and they are the extreme ones.
    Model model = sphere_model();
    model.anchors = {Vec3(0.0, 0.0, 0.08),  Vec3(0.0, 0.0, -0.0577), Vec3(0.09, 0.0, 0.0),
                     Vec3(-0.09, 0.0, 0.0), Vec3(0.0, 0.09, 0.0),    Vec3(0.0, -0.09, 0.0)};
    model.shape = [](const Vec3& p) { return (p - Vec3(0.0, 0.02, -0.0377)).norm() - 0.02; };
    EXPECT_GT(play(model, 20.0).contact_share(), 0.3);
}

TEST(ScriptedOperator, refuses_scenes_that_cannot_be_played)
{
    const OperatorScene good{sphere_model().anchors, kDiagonalM, kToolRadiusM, milliseconds(1),
                             1'000};
    EXPECT_TRUE(ScriptedOperator::create(good));
    const auto refusal = [&](auto&& spoil)
    {
        OperatorScene scene = good;
        spoil(scene);
        const auto made = ScriptedOperator::create(scene);
        return made ? std::string() : made.error().text;
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(refusal([](OperatorScene& s) { s.anchors_world_m.clear(); }).find("no anchor"),
              std::string::npos);
    EXPECT_NE(refusal([&](OperatorScene& s) { s.anchors_world_m[2].y() = nan; }).find("not finite"),
              std::string::npos);
    for (const double bad : {0.0, -1.0, nan})
    {
        EXPECT_NE(refusal([&](OperatorScene& s) { s.diagonal_m = bad; }).find("diagonal"),
                  std::string::npos);
        EXPECT_NE(refusal([&](OperatorScene& s) { s.tool_radius_m = bad; }).find("tool radius"),
                  std::string::npos);
    }
    EXPECT_NE(refusal([](OperatorScene& s) { s.tool_radius_m = 0.21; }).find("0.2"),
              std::string::npos);
    EXPECT_NE(refusal([](OperatorScene& s) { s.period = {}; }).find("period"), std::string::npos);
}

} // namespace
} // namespace tactus
