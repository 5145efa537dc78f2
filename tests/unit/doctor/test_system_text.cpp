// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/doctor/machine_view.hpp"

#include <gtest/gtest.h>

#include <random>

namespace tactus::doctor
{

namespace
{

TEST(SystemText, reads_integers_as_a_whole_or_not_at_all)
{
    EXPECT_EQ(parse_integer("-1"), -1);
    EXPECT_EQ(parse_integer("950000"), 950'000);
    for (const char* text : {"", "-", "1 ", "0x1", "1.5", "99999999999999999999", "one"})
    {
        EXPECT_FALSE(parse_integer(text)) << text;
    }
}

TEST(SystemText, reads_hexadecimal_with_and_without_its_sign)
{
    EXPECT_EQ(parse_hexadecimal("0x1003"), 0x1003U);
    EXPECT_EQ(parse_hexadecimal("000001fffeffffff"), 0x1fffeffffffU);
    for (const char* text : {"", "0x", "x1", "-1", "fffffffffffffffff", "0xg"})
    {
        EXPECT_FALSE(parse_hexadecimal(text)) << text;
    }
}

TEST(SystemText, reads_lists_of_processors)
{
    EXPECT_TRUE(parse_processor_list("")->none());
    EXPECT_EQ(parse_processor_list("0-2,5"), ProcessorSet(0b100111));
    EXPECT_TRUE(parse_processor_list("8191")->test(8191));
    for (const char* text :
         {",", "0,", "3-1", "-1", "1-", "8192", "0-99999999999", "a", "0 1", "(null)", "1--2"})
    {
        EXPECT_FALSE(parse_processor_list(text)) << text;
    }
}

TEST(SystemText, reads_masks_of_processors)
{
    EXPECT_EQ(parse_processor_mask("0000000b"), ProcessorSet(0b1011));
    EXPECT_TRUE(parse_processor_mask("1,00000000")->test(32));
    EXPECT_TRUE(parse_processor_mask("1,00000000")->count() == 1);
    std::string too_many = "1";
    for (std::size_t i = 0; i < kMostProcessors / 32; ++i)
    {
        too_many += ",00000000";
    }
    for (const std::string& text : {std::string(), std::string("1,"), std::string("1ffffffff"),
                                    std::string("g"), std::string("-1"), too_many})
    {
        EXPECT_FALSE(parse_processor_mask(text)) << text;
    }
}

TEST(SystemText, writes_what_it_reads)
{
    const unsigned seed = 20260101;
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    for (int i = 0; i < 200; ++i)
    {
        ProcessorSet set;
        for (int j = 0; j < i % 40 + 1; ++j)
        {
            set.set(random() % (i % 2 == 0 ? 70 : kMostProcessors));
        }
        EXPECT_EQ(parse_processor_list(processor_list(set)), set) << processor_list(set);
        EXPECT_EQ(parse_processor_mask(processor_mask(set)), set) << processor_mask(set);
        EXPECT_TRUE(set.test(static_cast<std::size_t>(lowest_of(set).value())));
        EXPECT_TRUE(set.test(static_cast<std::size_t>(highest_of(set).value())));
    }
}

TEST(SystemText, writes_no_processor_and_the_first_and_last)
{
    EXPECT_EQ(processor_list({}), "");
    EXPECT_EQ(processor_mask({}), "0");
    EXPECT_FALSE(lowest_of({}));
    EXPECT_FALSE(highest_of({}));
    const ProcessorSet ends = set_of(0) | set_of(33);
    EXPECT_EQ(processor_list(ends), "0,33");
    EXPECT_EQ(processor_mask(ends), "2,00000001");
    EXPECT_EQ(lowest_of(ends), 0);
    EXPECT_EQ(highest_of(ends), 33);
}

TEST(SystemText, finds_whole_words_only)
{
    EXPECT_TRUE(has_word("tsc hpet\tacpi_pm\n", "acpi_pm"));
    EXPECT_TRUE(has_word("tsc", "tsc"));
    EXPECT_FALSE(has_word("tsc-early hpet", "tsc"));
    EXPECT_FALSE(has_word("", "tsc"));
    EXPECT_FALSE(has_word("  ", "tsc"));
}

TEST(SystemText, shows_a_foreign_text_in_quotes)
{
    EXPECT_EQ(shown("a\x1b[2J\nb\xff"), "'a?[2J?b?'");
}

TEST(SystemText, makes_one_word_for_a_shell)
{
    EXPECT_EQ(shell_word("lo"), "'lo'");
    EXPECT_EQ(shell_word("a b;$(c)"), "'a b;$(c)'");
    EXPECT_EQ(shell_word("it's\n"), R"('it'\''s?')");
}

} // namespace

} // namespace tactus::doctor
