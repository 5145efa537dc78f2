// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/base/nearest_word.hpp"

#include <gtest/gtest.h>

#include <array>

namespace tactus
{

namespace
{

TEST(NearestWord, is_the_one_with_the_fewest_other_letters)
{
    constexpr std::array<std::string_view, 4> kWords{"point", "sphere", "sphinx", "box"};
    EXPECT_EQ(nearest_word("shpere", kWords), "sphere");
    EXPECT_EQ(nearest_word("sphere", kWords), "sphere");
    EXPECT_EQ(nearest_word("spheres", kWords), "sphere");
    EXPECT_EQ(nearest_word("bo", kWords), "box");
    EXPECT_EQ(nearest_word("points", kWords), "point");
}

TEST(NearestWord, is_none_where_nothing_is_near)
{
    constexpr std::array<std::string_view, 3> kWords{"point", "sphere", "a"};
    EXPECT_EQ(nearest_word("capsule", kWords), "");
    EXPECT_EQ(nearest_word("", kWords), "");
    EXPECT_EQ(nearest_word("z", kWords), ""); // "z" shares no letter with "a".
    EXPECT_EQ(nearest_word("point", {}), "");
}

} // namespace

} // namespace tactus
