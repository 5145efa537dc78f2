// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/fixture.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <string>

namespace tactus::hrtc
{
namespace
{

using tactus::test::Random;

VirtualFixture fixture_of(const std::string& words)
{
    const auto choice = parse_fixture(words);
    EXPECT_TRUE(choice) << words;
    return VirtualFixture(choice ? choice.value() : FixtureChoice{});
}

ExternalForce force_at(VirtualFixture& fixture, const Vec3& place_m, bool valid = true)
{
    ToolState tool;
    tool.position_m = place_m;
    tool.valid = valid;
    return fixture.next({}, tool, {});
}

} // namespace

TEST(VirtualFixture, pulls_to_a_point_a_line_and_to_the_front_of_a_plane)
{
    VirtualFixture point = fixture_of("point:0.1,0,0,200,5");
    EXPECT_LT((force_at(point, Vec3(0.11, 0.0, 0.0)).force_n - Vec3(-2.0, 0.0, 0.0)).norm(), 1e-12);
    EXPECT_EQ(force_at(point, Vec3(0.11, 0.0, 0.0)).stiffness_n_per_m, 200.0);
    VirtualFixture line = fixture_of("line:0,0,0.1,0,0,-3,200,5");
    EXPECT_LT((force_at(line, Vec3(0.0, 0.01, 7.0)).force_n - Vec3(0.0, -2.0, 0.0)).norm(), 1e-12);
    VirtualFixture plane = fixture_of("plane:0,0,0.1,0,0,2,200,5");
    EXPECT_EQ(force_at(plane, Vec3(3.0, 2.0, 0.1)).force_n, Vec3(0.0, 0.0, 0.0));
    EXPECT_EQ(force_at(plane, Vec3(3.0, 2.0, 0.2)).force_n, Vec3(0.0, 0.0, 0.0));
    EXPECT_LT((force_at(plane, Vec3(3.0, 2.0, 0.09)).force_n - Vec3(0.0, 0.0, 2.0)).norm(), 1e-12);
    VirtualFixture soft = fixture_of("point:0,0,0"); // 100 N/m, at most 1 N.
    EXPECT_NEAR(force_at(soft, Vec3(0.0, 0.005, 0.0)).force_n.y(), -0.5, 1e-12);
    EXPECT_NEAR(force_at(soft, Vec3(0.0, 0.0, -9.0)).force_n.z(), 1.0, 1e-12);
}

TEST(VirtualFixture, holds_a_gripper_so_far_open_and_leaves_the_hand_free)
{
    VirtualFixture fixture = fixture_of("gripper:0.02,200,3");
    ToolState tool;
    tool.valid = true;
    DeviceSample sample;
    sample.valid = true;
    const auto grip_n = [&](std::optional<double> open_m)
    {
        sample.gripper_m = open_m;
        const ExternalForce own = fixture.next(sample, tool, {});
        EXPECT_EQ(own.force_n, Vec3(0.0, 0.0, 0.0));
        return own.gripper_n;
    };
    EXPECT_EQ(grip_n({}), 0.0); // No command so far.
    EXPECT_NEAR(grip_n(0.03), -2.0, 1e-12);
    EXPECT_NEAR(grip_n(0.01), 2.0, 1e-12);
    EXPECT_EQ(grip_n(0.5), -3.0);
    EXPECT_EQ(grip_n({}), -3.0);
    EXPECT_EQ(grip_n(std::numeric_limits<double>::quiet_NaN()), -3.0);
    sample.valid = false;
    EXPECT_EQ(grip_n(0.02), -3.0);
}

TEST(VirtualFixture, makes_no_energy_on_any_way_that_closes)
{
    Random random(2'511);
    for (const std::string words :
         {"point:0.01,0,0,300,2", "line:0,0,0,1,2,3,300,2", "plane:0,0,0,1,-1,0.5,300,2"})
    {
        VirtualFixture fixture = fixture_of(words);
        for (int round = 0; round < 20; ++round)
        {
            // Closed path of three harmonics about all axes, for which trapezoids are exact except
            // where the spring saturates or releases.
            Mat3 swing;
            for (int i = 0; i < 9; ++i)
            {
                swing(i / 3, i % 3) = random.between(-0.02, 0.02);
            }
            const auto at = [&](double turn)
            { return Vec3(swing * Vec3(std::sin(turn), std::cos(2 * turn), std::sin(3 * turn))); };
            constexpr int kSteps = 20'000;
            double work_j = 0.0;
            double exchanged_j = 0.0;
            for (int i = 0; i < kSteps; ++i)
            {
                const Vec3 from_m = at(2.0 * M_PI * i / kSteps);
                const Vec3 to_m = at(2.0 * M_PI * (i + 1) / kSteps);
                const Vec3 mean_n =
                    0.5 * (force_at(fixture, from_m).force_n + force_at(fixture, to_m).force_n);
                work_j += mean_n.dot(to_m - from_m);
                exchanged_j += std::abs(mean_n.dot(to_m - from_m));
            }
            EXPECT_LT(std::abs(work_j), 1e-5 * exchanged_j + 1e-12) << words << ", " << round;
        }
    }
}

TEST(VirtualFixture, stays_as_it_was_while_the_device_says_no_place)
{
    VirtualFixture fixture = fixture_of("point:0,0,0");
    const Vec3 before_n = force_at(fixture, Vec3(0.005, 0.0, 0.0)).force_n;
    EXPECT_EQ(force_at(fixture, Vec3(0.002, 0.0, 0.0), false).force_n, before_n);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(force_at(fixture, Vec3(nan, 0.0, 0.0)).force_n, before_n);
    EXPECT_EQ(force_at(fixture, Vec3(0.0, 0.0, 0.0)).force_n, Vec3(0.0, 0.0, 0.0));
    const Vec3 far_n = force_at(fixture, Vec3(1e300, 1e300, 0.0)).force_n;
    EXPECT_TRUE(far_n.allFinite());
    EXPECT_LE(far_n.norm(), 1.0 + 1e-12);
}

TEST(VirtualFixture, takes_a_direction_of_any_length)
{
    const auto thin = parse_fixture("line:0,0,0,1e-300,0,0");
    ASSERT_TRUE(thin);
    EXPECT_LT((thin.value().direction - Vec3(1.0, 0.0, 0.0)).norm(), 1e-15);
}

} // namespace tactus::hrtc
