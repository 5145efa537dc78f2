// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plot/relief.hpp"
#include "tests/shared/count_of.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace tactus::plot::test
{

namespace
{

using tactus::test::count_of;

/// Square of a metre on the ground, of two faces.
Relief ground()
{
    return {.title = "way & force",
            .faces = {{{{-0.5F, -0.5F, 0.0F}, {0.5F, -0.5F, 0.0F}, {0.5F, 0.5F, 0.0F}}},
                      {{{-0.5F, -0.5F, 0.0F}, {0.5F, 0.5F, 0.0F}, {-0.5F, 0.5F, 0.0F}}}},
            .ways = {},
            .unit = "N",
            .note = {}};
}

TEST(Relief, draws_each_face_and_each_change_of_the_amount)
{
    Relief relief = ground();
    relief.ways = {{{{-0.5F, 0.0F, 0.2F}, 0.0F},
                    {{0.0F, 0.0F, 0.1F}, 0.0F},
                    {{0.1F, 0.0F, 0.0F}, 1.0F},
                    {{0.2F, 0.0F, 0.0F}, 0.95F},
                    {{0.5F, 0.0F, 0.0F}, 0.1F}}};
    const std::string sut = figure_of(relief);
    EXPECT_EQ(count_of(sut, "Z\"/>"), 2U);
    EXPECT_EQ(count_of(sut, "class=\"w w0\""), 1U);
    EXPECT_EQ(count_of(sut, "class=\"w w5\""), 1U);
    EXPECT_EQ(count_of(sut, "class=\"w w1\""), 1U);
    EXPECT_EQ(count_of(sut, "<svg"), 1U) << "a way across all needs no second view";
    EXPECT_NE(sut.find("way &amp; force"), std::string::npos);
    EXPECT_NE(sut.find(" 1 N at most"), std::string::npos);
}

TEST(Relief, has_a_view_of_its_own_for_a_way_that_takes_little_room)
{
    Relief relief = ground();
    relief.ways = {{{{0.0F, 0.0F, 0.0F}, 1.0F}, {{0.01F, 0.0F, 0.0F}, 2.0F}}};
    const std::string sut = figure_of(relief);
    EXPECT_EQ(count_of(sut, "<svg"), 2U);
    EXPECT_EQ(count_of(sut, "href=\"#relief\""), 1U);
}

TEST(Relief, draws_what_is_nearer_to_the_eye_over_what_is_farther)
{
    Relief relief;
    const auto face_at = [](float z) {
        return std::array<Place, 3>{{{0.0F, 0.0F, z}, {1.0F, 0.0F, z}, {1.0F, 1.0F, z}}};
    };
    relief.faces = {face_at(1.0F), face_at(0.0F)}; // View from above.
    const std::string one = figure_of(relief);
    relief.faces = {face_at(0.0F), face_at(1.0F)};
    EXPECT_EQ(one, figure_of(relief));
}

TEST(Relief, of_nothing_or_of_no_number_is_empty)
{
    EXPECT_EQ(figure_of({}), "");
    Relief relief = ground();
    relief.faces[0][0][0] = std::numeric_limits<float>::infinity();
    EXPECT_EQ(figure_of(relief), "");
    relief.faces.clear();
    relief.ways = {{}};
    EXPECT_EQ(figure_of(relief), "");
}

} // namespace

} // namespace tactus::plot::test
