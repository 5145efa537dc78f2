// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/export/mcap_writer.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <map>

// tests/integration/hrtc/read_exports.py reads whole files, field by field; these are the edge
// cases.
namespace tactus::test
{
namespace
{

using Bytes = std::vector<std::byte>;

constexpr int kMessageIndex = 7;
constexpr int kChunk = 6;
constexpr int kChunkIndex = 8;

/// Number of records of each kind outside the chunks; asserts that a file consists only of whole
/// records between two magics.
std::map<int, int> records_of(const Bytes& file)
{
    std::map<int, int> counts;
    std::size_t at = 8;
    while (at + 8 < file.size())
    {
        std::uint64_t size = 0;
        std::memcpy(&size, file.data() + at + 1, sizeof(size));
        ++counts[static_cast<int>(file[at])];
        at += 9 + size;
    }
    EXPECT_EQ(at + 8, file.size());
    EXPECT_EQ(std::memcmp(file.data(), "\x89MCAP0\r\n", 8), 0);
    EXPECT_EQ(std::memcmp(file.data() + file.size() - 8, "\x89MCAP0\r\n", 8), 0);
    return counts;
}

TEST(McapWriter, lays_out_a_file_without_messages)
{
    McapWriter sut("library");
    sut.finish();
    // Header, end of data, statistics, their index, footer.
    EXPECT_EQ(records_of(sut.take_bytes()),
              (std::map<int, int>{{0x01, 1}, {0x0F, 1}, {0x0B, 1}, {0x0E, 1}, {0x02, 1}}));
}

TEST(McapWriter, keeps_a_channel_that_nothing_was_sent_on)
{
    McapWriter sut("library");
    const auto schema = sut.add_schema("Name", "{}");
    static_cast<void>(sut.add_channel("/topic", schema));
    sut.finish();
    const auto counts = records_of(sut.take_bytes());
    EXPECT_EQ(counts.at(0x03), 1);
    EXPECT_EQ(counts.at(0x04), 1);
    EXPECT_EQ(counts.at(kChunk), 1); // Their first declaration.
    EXPECT_FALSE(counts.contains(kMessageIndex));
}

TEST(McapWriter, ends_a_chunk_where_it_is_full)
{
    McapWriter sut("library");
    const auto channel = sut.add_channel("/topic", sut.add_schema("Name", "{}"));
    const std::string half(McapWriter::kChunkBytes / 2, 'x');
    Bytes file;
    for (std::uint32_t i = 0; i < 5; ++i)
    {
        sut.add_message(channel, i, 100 - i, half); // Descending times.
        const Bytes more = sut.take_bytes();
        file.insert(file.end(), more.begin(), more.end());
    }
    sut.finish();
    const Bytes more = sut.take_bytes();
    file.insert(file.end(), more.begin(), more.end());
    const auto counts = records_of(file);
    EXPECT_EQ(counts.at(kChunk), 3); // Two messages each, and the last one.
    EXPECT_EQ(counts.at(kMessageIndex), 3);
    EXPECT_EQ(counts.at(kChunkIndex), 3);
}

} // namespace
} // namespace tactus::test
