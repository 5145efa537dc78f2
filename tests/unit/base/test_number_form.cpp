// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/base/number_form.hpp"
#include "transport/base/suggestions.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace tactus
{

namespace
{

constexpr NumberRange kLength{1e-5, 1.0, "m"};
constexpr NumberRange kOfBox[] = {kLength, kLength, kLength, {1e-5, 1.0, "m", true}};
constexpr NumberForm kBox{"box:X,Y,Z[,R]", kOfBox};
constexpr NumberRange kAnywhere{-100.0, 100.0, "m"};
constexpr NumberRange kOfPlace[] = {kAnywhere, kAnywhere, {1.0, 2.0}};
constexpr NumberForm kPlace{"A,B[,C]", kOfPlace};

std::string refusal_of(std::string_view value, const NumberForm& form)
{
    const auto sut = read_numbers(value, form);
    return sut ? "" : sut.error().text;
}

TEST(NumberForm, takes_as_many_numbers_as_the_form_has_with_or_without_what_is_in_brackets)
{
    EXPECT_EQ(read_numbers("box:0.1,0.2,0.3", kBox).value(), (std::vector{0.1, 0.2, 0.3}));
    EXPECT_EQ(read_numbers("box:0.1,0.2,0.3,0", kBox).value(), (std::vector{0.1, 0.2, 0.3, 0.0}));
    EXPECT_EQ(read_numbers("-100,1e2,2", kPlace).value(), (std::vector{-100.0, 100.0, 2.0}));
}

TEST(NumberForm, names_the_one_fault_and_what_may_have_been_meant)
{
    const std::string box = " is not box:X,Y,Z[,R]: ";
    const std::string place = " is not A,B[,C]: ";
    for (const auto& [value, fault] : {
             std::pair("box:2mm,1,1", box + "X must be in m, without a unit; box:0.002,1,1?"),
             std::pair("box:1,1e0cm,1,1in",
                       box + "Y must be in m, without a unit; box:1,0.01,1,0.0254?"),
             std::pair("box:5,1,1", box + "X is 5, not in 1e-05 .. 1 m; box:0.005,1,1?"),
             std::pair("box:5000,1,1", box + "X is 5000, not in 1e-05 .. 1 m"),
             std::pair("box:1,1,1,1e-6", box + "R is 1e-6, not in 1e-05 .. 1 m, nor 0"),
             std::pair("box:1,1", box + "the value has 2 numbers"),
             std::pair("box:1,1,1,1,1", box + "the value has 5 numbers"),
             std::pair("box:", box + "X is missing"),
             std::pair("box:1,,1", box + "Y is missing"),
             std::pair("box:1,1,wide", box + "Z is 'wide', not a number"),
             std::pair("box:1,1,1 ", box + "Z is '1 ', not a number"),
             std::pair("box:1,1,1s", box + "Z is '1s', not a number"),
             std::pair("box:1,nan,1", box + "Y is 'nan', not a number"),
             std::pair("3", place + "the value has 1 number; 3,0?"),
             std::pair("30mm", place + "A must be in m, without a unit; 0.03,0?"),
             std::pair("1,2,1m", place + "C is '1m', not a number"),
             std::pair("1,2,3", place + "C is 3, not in 1 .. 2"),
             std::pair("1,2\n", place + "B is '2?', not a number"),
         })
    {
        const NumberForm& form = std::string_view(value).starts_with("box:") ? kBox : kPlace;
        const std::string shown = std::string(value) == "1,2\n" ? "1,2?" : value;
        EXPECT_EQ(refusal_of(value, form), "'" + shown + "'" + fault);
    }
}

/// A proposed value is accepted.
TEST(NumberForm, means_nothing_that_it_would_refuse)
{
    for (const char* value : {"box:2mm,1,1", "box:5,1,1,0mm", "box:700,3cm,12in", "box:1,2"})
    {
        const std::string text = refusal_of(value, kBox);
        const std::size_t meant = text.rfind("; ");
        if (meant != std::string::npos)
        {
            EXPECT_EQ(refusal_of(text.substr(meant + 2, text.size() - meant - 3), kBox), "")
                << text;
        }
    }
}

} // namespace

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
