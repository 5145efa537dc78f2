// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/base/printable.hpp"
#include "transport/content_hash.hpp"
#include "transport/model_name.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tactus
{
namespace
{

TEST(ContentHash, is_the_first_half_of_blake2b_256)
{
    // b2sum -l 256 of nothing, and of the three letters.
    EXPECT_EQ(hash_text(content_hash({})), "0e5751c026e543b2e8ab2eb06099daa1");
    const std::string abc = "abc";
    EXPECT_EQ(hash_text(content_hash(std::as_bytes(std::span(abc)))),
              "bddd813c634239723171ef3fee98579b");
}

TEST(ContentHash, text_is_read_back_and_anything_else_is_refused)
{
    const ContentHash hash = content_hash({});
    EXPECT_EQ(parse_hash(hash_text(hash)), hash);
    EXPECT_EQ(parse_hash("0E5751C026E543B2E8AB2EB06099DAA1"), hash);
    EXPECT_FALSE(parse_hash(""));
    EXPECT_FALSE(parse_hash("0e5751c026e543b2e8ab2eb06099daa"));
    EXPECT_FALSE(parse_hash("0e5751c026e543b2e8ab2eb06099daa12"));
    EXPECT_FALSE(parse_hash("0e5751c026e543b2e8ab2eb06099daag"));
}

TEST(ModelName, allows_1_to_63_bytes_of_letters_and_digits)
{
    EXPECT_TRUE(is_valid_name("a"));
    EXPECT_TRUE(is_valid_name("Stanford-Bunny_2.1"));
    EXPECT_TRUE(is_valid_name(std::string(63, 'x')));
    EXPECT_TRUE(is_valid_name("W\u00FCrfel-\u03B1_\u65E5\u672C"));
    EXPECT_FALSE(is_valid_name(std::string(62, 'x').append("\u00FC")));
    EXPECT_FALSE(is_valid_name(""));
    EXPECT_FALSE(is_valid_name(std::string(64, 'x')));
    for (const char* name : {"a b", "a/b", "a\nb", "a\x1b[31m", "caf\xc3", "a@b", "*", "a\u00A0b",
                             "a\u200Bb", "a\u202Eb", "\u00ABa\u00BB"})
    {
        EXPECT_FALSE(is_valid_name(name)) << printable(name);
    }
}

TEST(ModelName, a_selector_is_a_name_and_perhaps_a_hash_or_a_server)
{
    const auto plain = parse_selector("bunny");
    ASSERT_TRUE(plain);
    EXPECT_EQ(plain.value().name, "bunny");
    EXPECT_FALSE(plain.value().hash);
    const auto pinned = parse_selector("bunny@0e5751c026e543b2e8ab2eb06099daa1");
    ASSERT_TRUE(pinned);
    EXPECT_EQ(pinned.value().hash, content_hash({}));
    EXPECT_TRUE(pinned.value().server.empty());
    for (const char* server : {"lab3", "lab3.example.org:812", "cert:91d177d5d766", "12"})
    {
        const auto of_one = parse_selector(std::string("bunny@") + server);
        ASSERT_TRUE(of_one);
        EXPECT_FALSE(of_one.value().hash);
        EXPECT_EQ(of_one.value().server, server);
    }
    EXPECT_EQ(parse_selector("bunny@lab 3").error().text,
              "'lab 3' after @ is neither a hash of 32 hexadecimal digits nor a server, "
              "MACHINE[:PROCESS] or cert: and 12 digits of 0-9 a-f");
    EXPECT_FALSE(parse_selector("bunny@"));
    EXPECT_FALSE(parse_selector("bunny@" + std::string(81, 'a')));
    EXPECT_EQ(parse_selector("b\tnny").error().text,
              "name 'b?nny' is not 1 to 63 bytes of letters, digits, . _ -");
    EXPECT_FALSE(parse_selector("@0e5751c026e543b2e8ab2eb06099daa1"));
}

} // namespace
} // namespace tactus
