// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/material_blend.hpp"
#include "tests/shared/period.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tactus::test
{

namespace
{

constexpr double kTool = 500.0;

Material random_material(Random& random)
{
    Material material;
    material.stiffness_n_per_m =
        random.between(0.0, 1.0) < 0.3 ? kInfinity : random.between(1.0, 3'000.0);
    material.static_friction = random.between(0.0, 2.0);
    material.dynamic_friction = random.between(0.0, 1.0) * material.static_friction;
    material.damping_n_s_per_m = random.between(0.0, 20.0);
    material.viscosity_n_s_per_m = random.between(0.0, 20.0);
    material.texture_length_m = random.between(2e-4, 0.1);
    material.texture_height_m =
        random.between(0.0, 1.0) * kTextureSteepest * material.texture_length_m;
    return material;
}

double stiffness_felt(const Material& material)
{
    return std::min(material.stiffness_n_per_m, kTool);
}

} // namespace

TEST(MaterialBlend, takes_its_time_in_even_steps_and_ends_at_what_is_wanted)
{
    Material soft;
    soft.stiffness_n_per_m = 100.0;
    MaterialBlend sut(soft);
    EXPECT_FALSE(sut.step(soft, kTool, kPeriod_s));
    EXPECT_EQ(sut.felt(), soft);
    Material firm;
    firm.stiffness_n_per_m = 400.0;
    firm.static_friction = firm.dynamic_friction = 0.5;
    const auto frames = static_cast<int>(std::lround(kMaterialBlend_s / kPeriod_s));
    double before = 100.0;
    for (int i = 1; i <= frames; ++i)
    {
        EXPECT_TRUE(sut.step(firm, kTool, kPeriod_s)) << i;
        EXPECT_NEAR(sut.felt().stiffness_n_per_m - before, 300.0 / frames, 1e-9);
        EXPECT_NEAR(sut.felt().static_friction, 0.5 * i / frames, 1e-12);
        before = sut.felt().stiffness_n_per_m;
    }
    // Rounding of the time may take one frame more.
    (void)sut.step(firm, kTool, kPeriod_s);
    EXPECT_EQ(sut.felt(), firm);
    EXPECT_FALSE(sut.step(firm, kTool, kPeriod_s));
}

TEST(MaterialBlend, is_sound_and_continuous_between_any_two_however_often_they_change)
{
    Random random(2502);
    Material wanted = random_material(random);
    MaterialBlend sut(wanted);
    for (int i = 0; i < 20'000; ++i)
    {
        wanted = random.between(0.0, 1.0) < 0.03 ? random_material(random) : wanted;
        const Material before = sut.felt();
        (void)sut.step(wanted, kTool, kPeriod_s);
        const Material& felt = sut.felt();
        ASSERT_TRUE(is_sound(felt)) << i;
        // The change is from a soft wall to the tool's own stiffness, or from a stiffer one.
        const double share = kPeriod_s / kMaterialBlend_s;
        EXPECT_LE(std::abs(stiffness_felt(felt) - stiffness_felt(before)), 3'000.0 * 1.01 * share)
            << i;
        EXPECT_LE(std::abs(felt.static_friction - before.static_friction), 2.0 * 1.01 * share) << i;
        EXPECT_LE(std::abs(felt.viscosity_n_s_per_m - before.viscosity_n_s_per_m),
                  20.0 * 1.01 * share)
            << i;
        if (felt.texture_length_m != before.texture_length_m)
        {
            EXPECT_LE(felt.texture_height_m, 2.01 * share * kTextureSteepest * 0.1) << i;
            EXPECT_LE(before.texture_height_m, 2.01 * share * kTextureSteepest * 0.1) << i;
        }
    }
}

} // namespace tactus::test
