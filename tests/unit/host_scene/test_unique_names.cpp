// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/scene_names.hpp"
#include "transport/model_name.hpp"

#include <gtest/gtest.h>

#include <set>

namespace tactus::test
{

namespace
{

using Names = std::vector<std::string>;

TEST(UniqueNames, plain_names_keep_what_the_wire_takes)
{
    EXPECT_EQ(plain_name("Arm_2.left-b"), "Arm_2.left-b");
    EXPECT_EQ(plain_name("a b/c\n"), "a_b_c_");
    EXPECT_EQ(plain_name("Kugel \u00E4"), "Kugel_\u00E4");
    EXPECT_EQ(plain_name("Geh\u00E4use/\u65E5\u672C\u00A0\u202Ex"), "Geh\u00E4use_\u65E5\u672C__x");
    EXPECT_EQ(plain_name("a\xC3-\xFF"), "a_-_");
    EXPECT_EQ(plain_name(std::string(62, 'x') + "\u00E4"), std::string(62, 'x'));
    EXPECT_EQ(plain_name(""), "");
    EXPECT_EQ(plain_name(std::string(64, 'x')), std::string(63, 'x'));
}

TEST(UniqueNames, the_first_keeps_its_name_and_nobody_takes_anothers)
{
    EXPECT_EQ(unique_names(Names{}), Names{});
    EXPECT_EQ(unique_names(Names{"a", "b", "a", "a"}), (Names{"a", "b", "a-2", "a-3"}));
    EXPECT_EQ(unique_names(Names{"a", "a", "a-2", "a"}), (Names{"a", "a-3", "a-2", "a-4"}));
    EXPECT_EQ(unique_names(Names{"a-2", "a-2", "a", "a"}), (Names{"a-2", "a-2-2", "a", "a-3"}));
}

TEST(UniqueNames, long_names_give_way_to_their_numbers)
{
    const Names names(1100, std::string(63, 'x'));
    const Names unique = unique_names(names);
    EXPECT_EQ(unique[1], std::string(61, 'x') + "-2");
    EXPECT_EQ(std::set(unique.begin(), unique.end()).size(), names.size());
    for (const std::string& name : unique)
    {
        EXPECT_TRUE(is_valid_name(name)) << name;
    }
}

} // namespace

} // namespace tactus::test
