// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/base/byte_io.hpp"
#include "rt_core/base/crc32c.hpp"
#include "tests/unit/rt_core/coded_bytes.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <utility>

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

RC_GTEST_PROP(BitReader, gives_fields_of_any_width_back, (std::uint32_t seed))
{
    Random random(seed);
    CodedBytes bytes;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> fields;
    for (int i = 0; i < 100; ++i)
    {
        const auto bits = static_cast<std::uint32_t>(random.below(33));
        const auto value =
            static_cast<std::uint32_t>(random.bits() & ((std::uint64_t{1} << bits) - 1));
        fields.emplace_back(bits, value);
        bytes.bits(bits, value);
    }
    BitReader sut(bytes.bytes());
    for (const auto& [bits, value] : fields)
    {
        RC_ASSERT(sut.read(bits) == value);
    }
}

} // namespace tactus::test
