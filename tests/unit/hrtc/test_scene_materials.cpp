// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/scene_materials.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace tactus::hrtc
{
namespace
{

using Words = std::vector<std::string>;

TEST(SceneMaterials, of_one_object_go_before_that_of_all_and_both_before_the_scene_s)
{
    SceneMaterials sut;
    const Material said{400.0};
    EXPECT_EQ(sut.material_for("cup", said), said);
    ASSERT_EQ(sut.parse(Words{"cup:800,0.6,0.4"}), "");
    EXPECT_EQ(sut.material_for("cup", said), (Material{800.0, 0.6, 0.4}));
    EXPECT_EQ(sut.material_for("pot", said), said);
    ASSERT_EQ(sut.parse(Words{"stiffness=200,damping=1"}), "");
    EXPECT_EQ(sut.material_for("cup", said), (Material{800.0, 0.6, 0.4}));
    EXPECT_EQ(sut.material_for("pot", said), (Material{200.0, 0.0, 0.0, 1.0}));
}

TEST(SceneMaterials, are_refused_for_what_is_wrong_with_them)
{
    const auto refusal = [](const Words& options) { return SceneMaterials().parse(options); };
    EXPECT_EQ(refusal({"100", "200"}), "--material: is given twice for all objects of the scene; "
                                       "use OBJECT:MATERIAL for one object");
    EXPECT_EQ(refusal({"cup:100", "pot:100", "cup:200"}), "--material: is given twice for 'cup'");
    EXPECT_EQ(refusal({":100"}),
              "--material: ':100': an object's name is missing before the colon");
    EXPECT_EQ(refusal({"cup:wood"}), "--material: 'wood' is not STIFFNESS[,STATIC[,DYNAMIC[,"
                                     "DAMPING]]]: STIFFNESS is 'wood', not a number");
}

TEST(SceneMaterials, of_an_object_that_is_not_there_are_told_with_the_nearest_name)
{
    SceneMaterials sut;
    ASSERT_EQ(sut.parse(Words{"cap:100"}), "");
    EXPECT_EQ(sut.missing(Words{"cap", "pot"}), "");
    EXPECT_EQ(sut.missing(Words{"cup", "pot"}), "--material: no object is called 'cap'; cup?");
    EXPECT_EQ(sut.missing(Words{"kitchen", "table"}),
              "--material: no object is called 'cap'; there are kitchen, table");
    EXPECT_EQ(no_such_object("x", Words(10, "kitchen")),
              "no object is called 'x'; there are kitchen, kitchen, kitchen, kitchen, kitchen, "
              "kitchen, kitchen, kitchen and 2 more");
}

} // namespace
} // namespace tactus::hrtc
