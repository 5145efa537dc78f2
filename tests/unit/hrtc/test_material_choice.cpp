// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/material_choice.hpp"

#include <gtest/gtest.h>

namespace tactus::hrtc
{

namespace
{

TEST(MaterialChoice, is_said_in_order_or_by_name)
{
    const auto in_order = parse_material("300,0.4,0.3,1");
    const auto by_name = parse_material("damping=1,static=0.4,stiffness=300,dynamic=0.3");
    ASSERT_TRUE(in_order && by_name);
    for (const Material& sut : {*in_order, *by_name})
    {
        EXPECT_EQ(sut.stiffness_n_per_m, 300.0);
        EXPECT_EQ(sut.static_friction, 0.4);
        EXPECT_EQ(sut.dynamic_friction, 0.3);
        EXPECT_EQ(sut.damping_n_s_per_m, 1.0);
    }
}

TEST(MaterialChoice, by_name_leaves_out_what_is_as_usual)
{
    const auto sut = parse_material("static=0.5");
    ASSERT_TRUE(sut);
    EXPECT_EQ(sut->stiffness_n_per_m, Material{}.stiffness_n_per_m);
    EXPECT_EQ(sut->static_friction, 0.5);
    EXPECT_EQ(sut->dynamic_friction, 0.5) << "the static one's";
    EXPECT_EQ(sut->damping_n_s_per_m, 0.0);
    EXPECT_EQ(parse_material("static=0.5,dynamic=0")->dynamic_friction, 0.0);
}

TEST(MaterialChoice, refuses_other_keys_values_and_ranges)
{
    for (const char* text : {"",
                             "stiffness",
                             "stiffness=",
                             "=5",
                             "stiffness=5,",
                             ",stiffness=5",
                             "stiffness=0",
                             "stiffness=3001",
                             "stiffness=nan",
                             "stiffness=inf",
                             "stiffness=5,stiffness=5",
                             "stiff=500",
                             "Stiffness=500",
                             "stiffness =500",
                             "stiffness=500;static=0.1",
                             "static=3.1",
                             "static=-0.1",
                             "static=0.2,dynamic=0.3",
                             "dynamic=0.1",
                             "damping=20.1",
                             "damping=-1",
                             "500,static=0.1",
                             "stiffness=500,0.1",
                             "stiffness=5=6",
                             "500,0.1,0.2"})
    {
        EXPECT_FALSE(parse_material(text)) << text;
    }
}

} // namespace

} // namespace tactus::hrtc
