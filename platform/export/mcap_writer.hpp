// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tactus
{

/// Formats an MCAP file, format version 0. Messages are in uncompressed chunks, each followed by
/// its indexes. A summary at the end lets a reader find any time without reading the rest. Chunks,
/// data and summary have checksums. The owner takes the bytes and stores them in order.
///
/// Messages and schemas are JSON: encodings "json" and "jsonschema". One thread, not the haptic
/// one: it allocates.
class McapWriter
{
public:
    /// Size at which a chunk ends, after the message that reaches it.
    static constexpr std::size_t kChunkBytes = std::size_t{1} << 20U;

    /// `library`: name of this program, for the file's header.
    explicit McapWriter(std::string_view library);

    /// Adds a schema and returns its id, 1 and up; at most 65,535 (asserted).
    [[nodiscard]] std::uint16_t add_schema(std::string_view name, std::string_view json_schema);
    /// Adds a channel and returns its id, 0 and up; its messages have this schema.
    [[nodiscard]] std::uint16_t add_channel(std::string_view topic, std::uint16_t schema);

    /// Adds a message. `sequence`: number that the source gave to the message. Times need not
    /// ascend.
    void add_message(std::uint16_t channel, std::uint32_t sequence, std::uint64_t time_ns,
                     std::string_view json);

    /// Closes the file, once, as the last call except take_bytes().
    void finish();

    /// Returns all bytes formatted since the last call.
    [[nodiscard]] std::vector<std::byte> take_bytes();

private:
    struct Span
    {
        std::uint64_t first_ns{0};
        std::uint64_t last_ns{0};
        std::uint64_t count{0};

        void add(std::uint64_t time_ns);
    };

    void close_chunk();
    void append(const std::vector<std::byte>& bytes);
    void append_group(std::uint8_t opcode, const std::vector<std::byte>& records,
                      std::vector<std::byte>& summary, std::vector<std::byte>& offsets) const;
    [[nodiscard]] std::vector<std::byte> statistics() const;

    std::vector<std::byte> bytes_;
    std::uint64_t position_{0}; ///< Position of the end of bytes_ in the file.
    std::uint32_t data_checksum_{0};

    std::vector<std::byte> chunk_; ///< Records of the open chunk.
    Span chunk_times_;
    /// Message times and offsets of the open chunk, by channel.
    std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> chunk_index_;

    std::vector<std::byte> schemas_;  ///< Schema records, repeated in the summary.
    std::vector<std::byte> channels_; ///< Channel records, repeated in the summary.
    std::vector<std::byte> chunk_indexes_;
    std::uint16_t schema_count_{0};
    std::map<std::uint16_t, std::uint64_t> messages_; ///< Messages of each channel.
    std::uint32_t chunk_count_{0};
    Span times_;
};

} // namespace tactus
