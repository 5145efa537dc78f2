// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/allocation_counter.hpp"
#include "platform/simulated/scripted_hand.hpp"
#include "platform/simulated/simulated_device.hpp"
#include "tests/unit/platform/fake_wall.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <ostream>
#include <set>

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

Model torus_model()
{
    std::vector<Vec3> anchors;
    for (int i = 0; i < 16; ++i)
    {
        for (int j = 0; j < 8; ++j)
        {
            const double u = i * 0.3926990817;
            const double v = j * 0.7853981634;
            const double ring = 0.05 + 0.02 * std::cos(v);
            anchors.emplace_back(ring * std::cos(u), ring * std::sin(u), 0.02 * std::sin(v));
        }
    }
    return {"torus", test::torus(0.05, 0.02), anchors};
}

Model plate_model()
{
    const Vec3 half(0.07, 0.07, 0.002);
    return {"plate", test::box(Vec3::Zero(), half), corners(Vec3::Zero(), half)};
}

/// So narrow that the hand slides over one edge after the other.
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
    std::vector<Vec3> proxy;
    std::vector<double> force_n;
    std::vector<HandPhase> phase;
    std::uint32_t lift_offs{0};
    std::uint64_t forces_clamped{0};
    std::uint64_t heap_calls{0};
    double workspace_radius_m{0.0};

    [[nodiscard]] double contact_share() const
    {
        const auto touching =
            std::count_if(force_n.begin(), force_n.end(), [](double force) { return force > 0.0; });
        return static_cast<double>(touching) / static_cast<double>(force_n.size());
    }
};

Recording play(const Model& model, double seconds, std::int64_t rate_hz = 1'000,
               double stiffness = 500.0)
{
    const auto frames = static_cast<std::uint64_t>(seconds * static_cast<double>(rate_hz));
    auto hand = std::move(ScriptedHand::create({model.anchors, kDiagonalM, kToolRadiusM,
                                                nanoseconds(1'000'000'000 / rate_hz), frames}))
                    .value();
    const ScriptedHand& script = *hand;
    SimulatedDeviceOptions options;
    options.rate_hz = rate_hz;
    options.workspace_centre_world_m = script.centre_world_m();
    options.workspace_radius_m = script.reach_m();
    test::FakeWall wall(model.shape, stiffness, kToolRadiusM, script.start_world_m());
    auto device = std::move(SimulatedDevice::create(options, std::move(hand))).value();
    Recording run;
    run.workspace_radius_m = options.workspace_radius_m;
    for (std::uint64_t frame = 0; frame < frames; ++frame)
    {
        const auto before = allocation_counter::of_this_thread();
        allocation_counter::mark_this_thread(true);
        const auto p = device->read().position_world_m;
        allocation_counter::mark_this_thread(false);
        run.heap_calls += allocation_counter::of_this_thread().allocations - before.allocations;
        const Vec3 force = wall.respond(Vec3(p[0], p[1], p[2]));
        device->write({force.x(), force.y(), force.z()});
        run.device.emplace_back(p[0], p[1], p[2]);
        run.proxy.push_back(wall.proxy());
        run.force_n.push_back(force.norm());
        run.phase.push_back(script.phase());
    }
    run.lift_offs = script.lift_offs();
    run.forces_clamped = device->status().forces_clamped;
    return run;
}

/// Speeds of the proxy while it slides, in diagonals a second. The first 150 ms after each landing
/// are left out: there the hand still presses in.
std::vector<double> sliding_speeds(const Recording& run)
{
    std::vector<double> speeds;
    std::size_t in_phase = 0;
    for (std::size_t i = 1; i < run.phase.size(); ++i)
    {
        in_phase = run.phase[i] == HandPhase::slide ? in_phase + 1 : 0;
        if (in_phase > 150 && run.force_n[i] > 0.0)
        {
            speeds.push_back((run.proxy[i] - run.proxy[i - 1]).norm() * 1'000.0 / kDiagonalM);
        }
    }
    return speeds;
}

class ScriptedHandOnModel : public testing::TestWithParam<Model>
{
};

INSTANTIATE_TEST_SUITE_P(Models, ScriptedHandOnModel,
                         testing::Values(sphere_model(), torus_model(), plate_model(),
                                         strip_model(), l_model()),
                         [](const auto& each) { return each.param.name; });

TEST_P(ScriptedHandOnModel, is_in_contact_for_most_of_runs_of_any_length)
{
    for (const double seconds : {3.0, 5.0, 10.0, 30.0})
    {
        EXPECT_GE(play(GetParam(), seconds).contact_share(), 0.65) << seconds << " s";
    }
}

TEST_P(ScriptedHandOnModel, lifts_off_at_least_three_times_and_really_leaves_the_surface)
{
    for (const double seconds : {3.0, 10.0})
    {
        const Recording run = play(GetParam(), seconds);
        EXPECT_GE(run.lift_offs, 3U) << seconds << " s";
        std::uint32_t left = 0;
        for (std::size_t i = 1; i < run.phase.size(); ++i)
        {
            const bool ended =
                run.phase[i - 1] == HandPhase::lift && run.phase[i] == HandPhase::descend;
            const double clearance_m = GetParam().shape(run.device[i]) - kToolRadiusM;
            left += ended && clearance_m > kToolRadiusM ? 1U : 0U;
        }
        EXPECT_GE(left, 3U) << seconds << " s";
    }
}

TEST_P(ScriptedHandOnModel, slides_at_a_tenth_of_a_diagonal_a_second)
{
    std::vector<double> speeds = sliding_speeds(play(GetParam(), 10.0));
    ASSERT_GT(speeds.size(), 5'000U);
    const auto good = std::count_if(speeds.begin(), speeds.end(),
                                    [](double speed) { return std::abs(speed - 0.1) <= 0.02; });
    std::ranges::nth_element(speeds,
                             speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() / 2));
    EXPECT_NEAR(speeds[speeds.size() / 2], 0.1, 0.01);
    // The hand is deeper than the edges of the strip are apart, and those take half of its time.
    const double share = GetParam().name == "strip" ? 0.5 : 0.8;
    EXPECT_GE(static_cast<double>(good) / static_cast<double>(speeds.size()), share);
}

TEST_P(ScriptedHandOnModel, presses_with_about_a_newton_and_never_near_the_limit)
{
    const Recording run = play(GetParam(), 10.0);
    double sum_n = 0.0;
    std::size_t touching = 0;
    for (const double force : run.force_n)
    {
        EXPECT_LT(force, 4.0);
        sum_n += force;
        touching += force > 0.0 ? 1U : 0U;
    }
    EXPECT_NEAR(sum_n / static_cast<double>(touching), 1.0, 0.2);
    EXPECT_EQ(run.forces_clamped, 0U);
}

TEST_P(ScriptedHandOnModel, stays_finite_and_within_the_workspace_it_asks_for)
{
    const Recording run = play(GetParam(), 5.0);
    for (const Vec3& point : run.device)
    {
        ASSERT_TRUE(point.allFinite());
        EXPECT_LT(point.norm(), run.workspace_radius_m + kDiagonalM);
    }
}

TEST_P(ScriptedHandOnModel, repeats_bit_for_bit)
{
    const Recording one = play(GetParam(), 3.0);
    const Recording two = play(GetParam(), 3.0);
    ASSERT_EQ(one.device.size(), two.device.size());
    for (std::size_t i = 0; i < one.device.size(); ++i)
    {
        ASSERT_EQ(std::memcmp(one.device[i].data(), two.device[i].data(), 3 * sizeof(double)), 0);
    }
}

TEST_P(ScriptedHandOnModel, touches_stiff_walls_and_at_high_rates_as_well)
{
    EXPECT_GE(play(GetParam(), 5.0, 4'000, 2'000.0).contact_share(), 0.65);
    EXPECT_GE(play(GetParam(), 5.0, 10'000, 3'000.0).contact_share(), 0.65);
}

TEST_P(ScriptedHandOnModel, leaves_the_heap_alone)
{
    if (!allocation_counter::available())
    {
        GTEST_SKIP() << "allocation counter: not available under a sanitizer or without glibc";
    }
    EXPECT_EQ(play(GetParam(), 3.0).heap_calls, 0U);
}

TEST(ScriptedHand, begins_in_free_flight_and_ends_in_free_air)
{
    const Recording run = play(sphere_model(), 3.0);
    EXPECT_EQ(run.phase.front(), HandPhase::flight);
    EXPECT_EQ(run.force_n.front(), 0.0);
    EXPECT_EQ(run.phase.back(), HandPhase::retreat);
    EXPECT_EQ(run.force_n.back(), 0.0);
    const std::set<HandPhase> seen(run.phase.begin(), run.phase.end());
    for (const HandPhase phase :
         {HandPhase::approach, HandPhase::slide, HandPhase::lift, HandPhase::descend})
    {
        EXPECT_TRUE(seen.contains(phase));
    }
}

TEST(ScriptedHand, flies_at_up_to_two_diagonals_a_second_and_outside_the_model)
{
    const Recording run = play(l_model(), 10.0);
    double fastest = 0.0;
    for (std::size_t i = 1; run.phase[i] == HandPhase::flight; ++i)
    {
        fastest =
            std::max(fastest, (run.device[i] - run.device[i - 1]).norm() * 1'000.0 / kDiagonalM);
        EXPECT_EQ(run.force_n[i], 0.0);
    }
    EXPECT_GT(fastest, 1.5);
    EXPECT_LT(fastest, 2.5);
}

TEST(ScriptedHand, moves_without_jumps)
{
    const Recording run = play(l_model(), 10.0);
    Vec3 last = Vec3::Zero();
    for (std::size_t i = 1; i < run.device.size(); ++i)
    {
        const Vec3 velocity = (run.device[i] - run.device[i - 1]) * 1'000.0;
        EXPECT_LT((velocity - last).norm(), 0.2) << "frame " << i;
        last = velocity;
    }
}

TEST(ScriptedHand, comes_back_after_an_edge)
{
    const Recording run = play(strip_model(), 30.0);
    // Contact is lost, or not: but it is never missing for long.
    std::size_t longest = 0;
    std::size_t current = 0;
    for (std::size_t i = 1'500; i + 1'000 < run.force_n.size(); ++i)
    {
        current = run.force_n[i] > 0.0 ? 0 : current + 1;
        longest = std::max(longest, current);
    }
    EXPECT_LT(longest, 1'000U);
}

TEST(ScriptedHand, goes_on_to_other_sites_when_the_first_is_empty)
{
    // Half of the anchors float where nothing is, and they are the extreme ones.
    Model model = sphere_model();
    model.anchors = {Vec3(0.0, 0.0, 0.08),  Vec3(0.0, 0.0, -0.0577), Vec3(0.09, 0.0, 0.0),
                     Vec3(-0.09, 0.0, 0.0), Vec3(0.0, 0.09, 0.0),    Vec3(0.0, -0.09, 0.0)};
    model.shape = [](const Vec3& p) { return (p - Vec3(0.0, 0.02, -0.0377)).norm() - 0.02; };
    EXPECT_GT(play(model, 20.0).contact_share(), 0.3);
}

TEST(ScriptedHand, survives_a_model_that_is_not_there)
{
    const Model nothing{"nothing", [](const Vec3&) { return 1.0; }, sphere_model().anchors};
    const Recording run = play(nothing, 10.0);
    EXPECT_EQ(run.contact_share(), 0.0);
    EXPECT_EQ(run.lift_offs, 0U);
    EXPECT_TRUE(run.device.back().allFinite());
}

TEST(ScriptedHand, plays_runs_that_are_too_short_for_everything)
{
    for (const double seconds : {0.001, 0.05, 0.5})
    {
        const Recording run = play(sphere_model(), seconds);
        EXPECT_TRUE(run.device.back().allFinite());
    }
}

TEST(ScriptedHand, refuses_scenes_that_cannot_be_played)
{
    const HandScene good{sphere_model().anchors, kDiagonalM, kToolRadiusM, milliseconds(1), 1'000};
    EXPECT_TRUE(ScriptedHand::create(good));
    const auto refusal = [&](auto&& spoil)
    {
        HandScene scene = good;
        spoil(scene);
        const auto made = ScriptedHand::create(scene);
        return made ? std::string() : made.error().text;
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(refusal([](HandScene& s) { s.anchors_world_m.clear(); }).find("no anchor"),
              std::string::npos);
    EXPECT_NE(refusal([&](HandScene& s) { s.anchors_world_m[2].y() = nan; }).find("not finite"),
              std::string::npos);
    for (const double bad : {0.0, -1.0, nan})
    {
        EXPECT_NE(refusal([&](HandScene& s) { s.diagonal_m = bad; }).find("diagonal"),
                  std::string::npos);
        EXPECT_NE(refusal([&](HandScene& s) { s.tool_radius_m = bad; }).find("tool radius"),
                  std::string::npos);
    }
    EXPECT_NE(refusal([](HandScene& s) { s.tool_radius_m = 0.21; }).find("0.2"), std::string::npos);
    EXPECT_NE(refusal([](HandScene& s) { s.period = {}; }).find("period"), std::string::npos);
}

} // namespace

} // namespace tactus
