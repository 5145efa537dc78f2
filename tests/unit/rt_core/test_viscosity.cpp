// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// What a viscous surface does to a ball: the oracle is a damper in series with the spring.

#include "tests/unit/rt_core/proxy_rig.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tactus::test
{

namespace
{

constexpr double kDepth = 0.002;

Vec3 pressed_in(double x_m)
{
    return {x_m, 0.0, kRadius - kDepth};
}

/// The force after a slide of a second at this speed.
ToolOutput slide(const Material& material, double speed_m_per_s)
{
    ProxyRig rig(plane(), Vec3(0, 0, 0.02));
    rig.material = material;
    ToolOutput output = rig.settle(pressed_in(0.0), 20);
    for (int i = 1; i <= 1'000; ++i)
    {
        output = rig.step_on(pressed_in(speed_m_per_s * kPeriod_s * i), Vec3(speed_m_per_s, 0, 0));
    }
    return output;
}

} // namespace

TEST(Viscosity, drags_with_viscosity_times_speed_beside_friction)
{
    for (const double viscosity : {0.5, 2.0, 10.0})
    {
        for (const double speed_m_per_s : {0.01, 0.05, 0.2})
        {
            Material material;
            material.viscosity_n_s_per_m = viscosity;
            const double drag_n = viscosity * speed_m_per_s;
            const ToolOutput alone = slide(material, speed_m_per_s);
            EXPECT_NEAR(alone.force_n.x(), -drag_n, 0.01 * drag_n + 1e-3);
            EXPECT_NEAR(alone.force_n.z(), kStiffness * kDepth, 1e-3);
            material.static_friction = material.dynamic_friction = 0.3;
            const double both_n = drag_n + 0.3 * kStiffness * kDepth;
            EXPECT_NEAR(slide(material, speed_m_per_s).force_n.x(), -both_n, 0.01 * both_n + 1e-3)
                << viscosity << " at " << speed_m_per_s;
        }
    }
}

TEST(Viscosity, lets_go_of_a_hand_at_rest_as_spring_and_damper_do)
{
    Material material;
    material.viscosity_n_s_per_m = 5.0;
    ProxyRig rig(plane(), Vec3(0, 0, 0.02));
    rig.material = material;
    (void)rig.settle(pressed_in(0.0), 20);
    double stretch_m = 0.001;
    // Backward Euler of v = K s / c, as a damper in series with a spring has it.
    const double kept =
        material.viscosity_n_s_per_m / (material.viscosity_n_s_per_m + kStiffness * kPeriod_s);
    for (int frame = 0; frame < 40; ++frame)
    {
        const ToolOutput output = rig.step(pressed_in(0.001));
        stretch_m *= kept;
        EXPECT_NEAR(output.force_n.x(), -kStiffness * stretch_m, 2e-3) << frame;
    }
    material.viscosity_n_s_per_m = kDampingMax_n_s_per_m;
    rig.material = material;
    const ToolOutput held = rig.settle(pressed_in(-0.003), 50);
    EXPECT_NEAR(held.force_n.x(), kStiffness * (held.proxy_m.x() + 0.003), 1e-9)
        << "never more than the spring";
}

TEST(Viscosity, makes_no_energy_whatever_the_hand_does)
{
    for (std::uint32_t seed = 1; seed <= 8; ++seed)
    {
        Random random(seed);
        ProxyRig rig(plane(), Vec3(0, 0, 0.02));
        rig.material.viscosity_n_s_per_m = std::pow(10.0, random.between(-2.0, 4.0));
        Vec3 hand = pressed_in(0.0);
        (void)rig.settle(hand, 20);
        double work_j = 0.0;
        for (int step = 0; step < 4'000; ++step)
        {
            Vec3 next = hand + random.in_cube(5e-4);
            next.z() = hand.z(); // Along the surface alone: there is no other spring to ask.
            next *= std::min(1.0, 0.05 / next.norm());
            next.z() = hand.z();
            const ToolOutput now = rig.step(next);
            work_j += now.force_n.dot(next - hand);
            const double stretch_m = (now.proxy_m - next).head<2>().norm();
            // Never more than the spring has: what it holds was given to it.
            EXPECT_LE(work_j + 0.5 * kStiffness * stretch_m * stretch_m, 1e-5) << seed;
            hand = next;
        }
    }
}

TEST(Viscosity, takes_a_resting_hand_along_with_a_surface_that_slides)
{
    ProxyRig rig(plane(), Vec3(0, 0, 0.02));
    rig.material.viscosity_n_s_per_m = 4.0;
    ToolOutput output = rig.settle(pressed_in(0.0), 20);
    ObjectPose pose;
    for (int i = 0; i < 300; ++i)
    {
        pose.translation_m.x() += 0.1 * kPeriod_s;
        output = rig.step(pressed_in(0.0), pose);
    }
    EXPECT_NEAR(output.force_n.x(), 0.4, 0.01);
}

} // namespace tactus::test
