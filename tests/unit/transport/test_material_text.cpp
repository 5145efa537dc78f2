// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/material_text.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

namespace tactus::test
{
namespace
{

TEST(MaterialText, is_said_in_order_or_by_name)
{
    const auto in_order = parse_material("300,0.4,0.3,1");
    const auto by_name = parse_material("damping=1,static=0.4,stiffness=300,dynamic=0.3");
    ASSERT_TRUE(in_order && by_name);
    for (const Material& sut : {in_order.value(), by_name.value()})
    {
        EXPECT_EQ(sut.stiffness_n_per_m, 300.0);
        EXPECT_EQ(sut.static_friction, 0.4);
        EXPECT_EQ(sut.dynamic_friction, 0.3);
        EXPECT_EQ(sut.damping_n_s_per_m, 1.0);
    }
}

TEST(MaterialText, by_name_leaves_out_what_is_as_usual)
{
    const auto sut = parse_material("static=0.5");
    ASSERT_TRUE(sut);
    EXPECT_EQ(sut.value().stiffness_n_per_m, Material{}.stiffness_n_per_m);
    EXPECT_EQ(sut.value().static_friction, 0.5);
    EXPECT_EQ(sut.value().dynamic_friction, 0.5) << "the static one's";
    EXPECT_EQ(sut.value().damping_n_s_per_m, 0.0);
    EXPECT_EQ(parse_material("static=0.5,dynamic=0").value().dynamic_friction, 0.0);
}

TEST(MaterialText, has_a_name_for_each_value)
{
    const auto sut = parse_material_keys("viscosity=2,texture_height=1e-4,texture_length=5e-3");
    ASSERT_TRUE(sut);
    EXPECT_EQ(sut.value().viscosity_n_s_per_m, 2.0);
    EXPECT_EQ(sut.value().texture_height_m, 1e-4);
    EXPECT_EQ(sut.value().texture_length_m, 5e-3);
    EXPECT_EQ(kMaterialKeys.size() * sizeof(double), sizeof(Material));
    EXPECT_FALSE(parse_material_keys("500,0.1")) << "in order it is said where options are";
}

TEST(MaterialText, refuses_other_keys_values_and_ranges)
{
    // Values are separated by bars.
    std::istringstream wrong(
        "|stiffness|stiffness=|=5|stiffness=5,|,stiffness=5|stiffness=0|stiffness=3001|"
        "stiffness=nan|stiffness=inf|stiffness=5,stiffness=5|stiff=500|Stiffness=500|"
        "stiffness =500|stiffness=500;static=0.1|static=3.1|static=-0.1|"
        "static=0.2,dynamic=0.3|dynamic=0.1|damping=20.1|damping=-1|viscosity=-1|"
        "viscosity=20.1|texture_height=1e-5|texture_height=1e-5,texture_length=9e-5|"
        "texture_height=1e-4,texture_length=3e-3|texture_height=-1e-5,texture_length=1e-2|"
        "texture_length=1.1|500,static=0.1|stiffness=500,0.1|stiffness=5=6|500,0.1,0.2");
    for (std::string text; std::getline(wrong, text, '|');)
    {
        EXPECT_FALSE(parse_material(text)) << text;
    }
}

} // namespace
} // namespace tactus::test
