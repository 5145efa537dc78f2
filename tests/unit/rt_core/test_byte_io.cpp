// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/base/byte_io.hpp"
#include "rt_core/base/crc32c.hpp"
#include "tests/unit/rt_core/coded_bytes.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <string_view>

namespace tactus::test
{

namespace
{

std::vector<std::byte> bytes_of(std::initializer_list<int> values)
{
    std::vector<std::byte> bytes;
    for (const int value : values)
    {
        bytes.push_back(static_cast<std::byte>(value));
    }
    return bytes;
}

std::vector<std::byte> bytes_of(std::string_view text)
{
    const auto bytes = std::as_bytes(std::span(text));
    return {bytes.begin(), bytes.end()};
}

} // namespace

TEST(ByteReader, reads_little_endian_values_in_order)
{
    const auto bytes = bytes_of({0x01, 0x34, 0x12, 0x78, 0x56, 0x34, 0x12});
    ByteReader sut(bytes);

    EXPECT_EQ(sut.read<std::uint8_t>(), 1);
    EXPECT_EQ(sut.read<std::uint16_t>(), 0x1234);
    EXPECT_EQ(sut.position(), 3U);
    EXPECT_EQ(sut.remaining(), 4U);
    EXPECT_EQ(sut.read<std::uint32_t>(), 0x1234'5678U);
    EXPECT_TRUE(sut.at_end());
    EXPECT_FALSE(sut.failed());
}

TEST(ByteReader, a_value_cut_at_any_byte_fails_for_good)
{
    const auto bytes = bytes_of({1, 2, 3, 4, 5, 6, 7, 8});
    for (std::size_t length = 0; length < 8; ++length)
    {
        ByteReader sut{std::span(bytes).first(length)};

        EXPECT_EQ(sut.read<std::uint64_t>(), 0U);
        EXPECT_TRUE(sut.failed());
        EXPECT_EQ(sut.read<std::uint8_t>(), 0);
        EXPECT_TRUE(sut.failed());
        EXPECT_EQ(sut.remaining(), 0U);
    }
}

TEST(ByteReader, hands_out_bytes_and_refuses_more_than_there_are)
{
    const auto bytes = bytes_of({1, 2, 3});
    ByteReader sut(bytes);

    EXPECT_EQ(sut.read_bytes(2).size(), 2U);
    EXPECT_TRUE(sut.read_bytes(0).empty());
    EXPECT_FALSE(sut.failed());
    EXPECT_TRUE(sut.read_bytes(std::numeric_limits<std::size_t>::max()).empty());
    EXPECT_TRUE(sut.failed());
}

TEST(ByteReader, a_varint_cut_at_any_byte_fails)
{
    const auto whole = bytes_of({0xFF, 0xFF, 0xFF, 0xFF, 0x0F});
    ByteReader all(whole);
    EXPECT_EQ(all.read_varint(), 0xFFFF'FFFFU);
    EXPECT_FALSE(all.failed());
    for (std::size_t length = 0; length < whole.size(); ++length)
    {
        ByteReader sut{std::span(whole).first(length)};
        static_cast<void>(sut.read_varint());
        EXPECT_TRUE(sut.failed()) << length;
        EXPECT_TRUE(sut.at_end()) << length;
    }
}

TEST(ByteReader, a_varint_beyond_32_bits_or_five_bytes_fails)
{
    for (const auto& bytes :
         {bytes_of({0xFF, 0xFF, 0xFF, 0xFF, 0x10}), bytes_of({0x80, 0x80, 0x80, 0x80, 0x7F}),
          bytes_of({0x80, 0x80, 0x80, 0x80, 0x80, 0x00}),
          bytes_of({0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x01})})
    {
        ByteReader sut(bytes);
        EXPECT_EQ(sut.read_varint(), 0U);
        EXPECT_TRUE(sut.failed());
    }
}

RC_GTEST_PROP(ByteReader, varints_come_back_as_they_were_written, ())
{
    const auto value = *rc::gen::arbitrary<std::uint32_t>();
    const auto shift = *rc::gen::inRange(0, 32);
    const std::uint32_t sized = value >> static_cast<unsigned>(shift);
    const auto bytes = CodedBytes().varint(sized).bytes();
    ByteReader sut(bytes);

    RC_ASSERT(sut.read_varint() == sized);
    RC_ASSERT(sut.at_end() && !sut.failed());
}

TEST(ByteReader, signed_varints_come_back_as_they_were_written)
{
    Random random(2);
    std::vector<std::int32_t> values{0, 1, -1, std::numeric_limits<std::int32_t>::max(),
                                     std::numeric_limits<std::int32_t>::min()};
    for (int i = 0; i < 10'000; ++i)
    {
        values.push_back(static_cast<std::int32_t>(random.bits() >> 32U) >> random.below(32));
    }
    CodedBytes written;
    for (const std::int32_t value : values)
    {
        written.zigzag(value);
    }
    ByteReader sut(written.bytes());
    for (const std::int32_t value : values)
    {
        ASSERT_EQ(sut.read_signed_varint(), value);
    }
    EXPECT_TRUE(sut.at_end() && !sut.failed());
}

TEST(Crc32c, gives_the_published_check_values)
{
    EXPECT_EQ(crc32c(bytes_of("123456789")), 0xE306'9283U);
    EXPECT_EQ(crc32c({}), 0U);
    // RFC 3720, appendix B.4: 32 bytes of zeros, of ones, and counting up.
    EXPECT_EQ(crc32c(std::vector<std::byte>(32, std::byte{0})), 0x8A91'36AAU);
    EXPECT_EQ(crc32c(std::vector<std::byte>(32, std::byte{0xFF})), 0x62A8'AB43U);
    std::vector<std::byte> counting;
    for (int i = 0; i < 32; ++i)
    {
        counting.push_back(static_cast<std::byte>(i));
    }
    EXPECT_EQ(crc32c(counting), 0x46DD'794EU);
}

TEST(Crc32c, every_single_bit_flip_changes_it)
{
    Random random(3);
    std::vector<std::byte> bytes(300);
    for (std::byte& byte : bytes)
    {
        byte = static_cast<std::byte>(random.bits());
    }
    const std::uint32_t whole = crc32c(bytes);
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit)
    {
        flip_bit(bytes, bit);
        ASSERT_NE(crc32c(bytes), whole) << bit;
        flip_bit(bytes, bit);
    }
    EXPECT_EQ(crc32c(bytes), whole);
}

} // namespace tactus::test
