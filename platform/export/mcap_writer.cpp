// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/export/mcap_writer.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/base/crc32c.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <type_traits>

namespace tactus
{

// A file consists of magic and header; chunks with their indexes; end of data; summary, in groups
// of one kind of record; offsets of the groups; footer and magic. A record is a u8 opcode, the u64
// length of its content, and the content; integers are little-endian, texts and arrays follow their
// length in bytes as u32.
namespace
{

using Bytes = std::vector<std::byte>;

constexpr std::array<unsigned char, 8> kMagic{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};

namespace opcode
{
constexpr std::uint8_t kHeader = 0x01;
constexpr std::uint8_t kFooter = 0x02;
constexpr std::uint8_t kSchema = 0x03;
constexpr std::uint8_t kChannel = 0x04;
constexpr std::uint8_t kMessage = 0x05;
constexpr std::uint8_t kChunk = 0x06;
constexpr std::uint8_t kMessageIndex = 0x07;
constexpr std::uint8_t kChunkIndex = 0x08;
constexpr std::uint8_t kStatistics = 0x0B;
constexpr std::uint8_t kSummaryOffset = 0x0E;
constexpr std::uint8_t kDataEnd = 0x0F;
} // namespace opcode

template <typename Integer>
void put(Bytes& bytes, Integer value)
{
    static_assert(std::is_unsigned_v<Integer>);
    for (std::size_t i = 0; i < sizeof(value); ++i)
    {
        bytes.push_back(static_cast<std::byte>(static_cast<std::uint64_t>(value) >> (8 * i)));
    }
}

void put_bytes(Bytes& bytes, std::span<const std::byte> more)
{
    bytes.insert(bytes.end(), more.begin(), more.end());
}

void put_text(Bytes& bytes, std::string_view text)
{
    TACTUS_ASSERT(text.size() <= std::numeric_limits<std::uint32_t>::max());
    put(bytes, static_cast<std::uint32_t>(text.size()));
    put_bytes(bytes, std::as_bytes(std::span(text)));
}

void put_record(Bytes& bytes, std::uint8_t code, std::span<const std::byte> content)
{
    put(bytes, code);
    put(bytes, std::uint64_t{content.size()});
    put_bytes(bytes, content);
}

/// CRC-32 of IEEE 802.3.
std::uint32_t ieee_crc32(std::span<const std::byte> bytes, std::uint32_t before = 0)
{
    return crc32_by<0xEDB8'8320U>(bytes, before);
}

void put_magic(Bytes& bytes)
{
    put_bytes(bytes, std::as_bytes(std::span(kMagic)));
}

} // namespace

void McapWriter::Span::add(std::uint64_t time_ns)
{
    first_ns = count == 0 ? time_ns : std::min(first_ns, time_ns);
    last_ns = count == 0 ? time_ns : std::max(last_ns, time_ns);
    ++count;
}

McapWriter::McapWriter(std::string_view library)
{
    Bytes content;
    put_text(content, ""); // The profile is empty.
    put_text(content, library);
    Bytes start;
    put_magic(start);
    put_record(start, opcode::kHeader, content);
    append(start);
}

std::uint16_t McapWriter::add_schema(std::string_view name, std::string_view json_schema)
{
    TACTUS_ASSERT(schema_count_ < std::numeric_limits<std::uint16_t>::max());
    const auto id = ++schema_count_; // Id 0 means no schema.
    Bytes content;
    put(content, id);
    put_text(content, name);
    put_text(content, "jsonschema");
    put_text(content, json_schema);
    put_record(chunk_, opcode::kSchema, content);
    put_record(schemas_, opcode::kSchema, content);
    return id;
}

std::uint16_t McapWriter::add_channel(std::string_view topic, std::uint16_t schema)
{
    TACTUS_ASSERT(messages_.size() < std::numeric_limits<std::uint16_t>::max());
    const auto id = static_cast<std::uint16_t>(messages_.size());
    Bytes content;
    put(content, id);
    put(content, schema);
    put_text(content, topic);
    put_text(content, "json");
    put(content, std::uint32_t{0}); // It has no metadata.
    put_record(chunk_, opcode::kChannel, content);
    put_record(channels_, opcode::kChannel, content);
    messages_[id] = 0;
    return id;
}

void McapWriter::add_message(std::uint16_t channel, std::uint32_t sequence, std::uint64_t time_ns,
                             std::string_view json)
{
    TACTUS_ASSERT(messages_.contains(channel));
    chunk_index_[channel].emplace_back(time_ns, chunk_.size());
    Bytes content;
    put(content, channel);
    put(content, sequence);
    put(content, time_ns); // Logged and published at the same time.
    put(content, time_ns);
    put_bytes(content, std::as_bytes(std::span(json)));
    put_record(chunk_, opcode::kMessage, content);
    chunk_times_.add(time_ns);
    times_.add(time_ns);
    ++messages_[channel];
    if (chunk_.size() >= kChunkBytes)
    {
        close_chunk();
    }
}

void McapWriter::close_chunk()
{
    const std::uint64_t start = position_;
    Bytes content;
    put(content, chunk_times_.first_ns);
    put(content, chunk_times_.last_ns);
    put(content, std::uint64_t{chunk_.size()});
    put(content, ieee_crc32(chunk_));
    put_text(content, ""); // The chunk is not compressed.
    put(content, std::uint64_t{chunk_.size()});
    put_bytes(content, chunk_);
    Bytes record;
    put_record(record, opcode::kChunk, content);
    append(record);
    const std::uint64_t indexes_start = position_;

    Bytes places; // Offsets of the message indexes in the file, by channel.
    for (const auto& [channel, messages] : chunk_index_)
    {
        put(places, channel);
        put(places, position_);
        Bytes index;
        put(index, channel);
        put(index, static_cast<std::uint32_t>(messages.size() * 16));
        for (const auto& [time_ns, offset] : messages)
        {
            put(index, time_ns);
            put(index, offset);
        }
        Bytes index_record;
        put_record(index_record, opcode::kMessageIndex, index);
        append(index_record);
    }

    Bytes chunk_index;
    put(chunk_index, chunk_times_.first_ns);
    put(chunk_index, chunk_times_.last_ns);
    put(chunk_index, start);
    put(chunk_index, indexes_start - start);
    put(chunk_index, static_cast<std::uint32_t>(places.size()));
    put_bytes(chunk_index, places);
    put(chunk_index, position_ - indexes_start);
    put_text(chunk_index, "");
    put(chunk_index, std::uint64_t{chunk_.size()});
    put(chunk_index, std::uint64_t{chunk_.size()});
    put_record(chunk_indexes_, opcode::kChunkIndex, chunk_index);

    ++chunk_count_;
    chunk_.clear();
    chunk_index_.clear();
    chunk_times_ = {};
}

Bytes McapWriter::statistics() const
{
    Bytes content;
    put(content, times_.count);
    put(content, schema_count_);
    put(content, static_cast<std::uint32_t>(messages_.size()));
    put(content, std::uint32_t{0}); // Number of attachments.
    put(content, std::uint32_t{0}); // Number of metadata records.
    put(content, chunk_count_);
    put(content, times_.first_ns);
    put(content, times_.last_ns);
    put(content, static_cast<std::uint32_t>(messages_.size() * 10));
    for (const auto& [channel, count] : messages_)
    {
        put(content, channel);
        put(content, count);
    }
    Bytes record;
    put_record(record, opcode::kStatistics, content);
    return record;
}

void McapWriter::append_group(std::uint8_t code, const Bytes& records, Bytes& summary,
                              Bytes& offsets) const
{
    if (records.empty())
    {
        return;
    }
    Bytes content;
    put(content, code);
    put(content, position_ + summary.size());
    put(content, std::uint64_t{records.size()});
    put_record(offsets, opcode::kSummaryOffset, content);
    put_bytes(summary, records);
}

void McapWriter::finish()
{
    if (!chunk_.empty())
    {
        close_chunk();
    }
    Bytes data_end;
    put(data_end, data_checksum_);
    Bytes end;
    put_record(end, opcode::kDataEnd, data_end);
    append(end);

    Bytes summary;
    Bytes offsets;
    append_group(opcode::kSchema, schemas_, summary, offsets);
    append_group(opcode::kChannel, channels_, summary, offsets);
    append_group(opcode::kStatistics, statistics(), summary, offsets);
    append_group(opcode::kChunkIndex, chunk_indexes_, summary, offsets);
    const std::uint64_t start = position_;
    const std::uint64_t offsets_start = position_ + summary.size();
    put_bytes(summary, offsets);
    // The summary's checksum includes the start of the footer.
    put(summary, opcode::kFooter);
    put(summary, std::uint64_t{20});
    put(summary, start);
    put(summary, offsets_start);
    put(summary, ieee_crc32(summary));
    put_magic(summary);
    append(summary);
}

void McapWriter::append(const Bytes& bytes)
{
    put_bytes(bytes_, bytes);
    position_ += bytes.size();
    data_checksum_ = ieee_crc32(bytes, data_checksum_);
}

Bytes McapWriter::take_bytes()
{
    return std::exchange(bytes_, {});
}

} // namespace tactus
