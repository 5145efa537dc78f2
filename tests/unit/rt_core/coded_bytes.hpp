// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/header.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>
#include <vector>

namespace tactus::test
{

/// CRC-32C bit by bit, without a table: the writer shares no code with the reader.
[[nodiscard]] inline std::uint32_t bitwise_crc32c(std::span<const std::byte> bytes)
{
    std::uint32_t state = 0xFFFF'FFFFU;
    for (const std::byte byte : bytes)
    {
        for (unsigned bit = 0; bit < 8; ++bit)
        {
            const std::uint32_t in = (static_cast<std::uint32_t>(byte) >> bit) & 1U;
            const bool feeds_back = ((state ^ in) & 1U) != 0;
            state = (state >> 1U) ^ (feeds_back ? 0x82F6'3B78U : 0U);
        }
    }
    return ~state;
}

/// Bytes written one value after the other.
class CodedBytes
{
public:
    template <typename T>
    CodedBytes& put(const T& value)
    {
        const auto bytes = std::as_bytes(std::span(&value, 1));
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
        return *this;
    }
    /// Appends a field of bits, lowest first, after the previous one.
    CodedBytes& bits(std::uint32_t count, std::uint32_t value)
    {
        for (std::uint32_t i = 0; i < count; ++i, ++bit_)
        {
            if (bit_ % 8 == 0)
            {
                bytes_.push_back(std::byte{0});
            }
            bytes_.back() |= static_cast<std::byte>(((value >> i) & 1U) << (bit_ % 8));
        }
        return *this;
    }
    CodedBytes& append(std::span<const std::byte> other)
    {
        bytes_.insert(bytes_.end(), other.begin(), other.end());
        return *this;
    }
    CodedBytes& zeros(std::size_t count)
    {
        bytes_.resize(bytes_.size() + count);
        return *this;
    }
    [[nodiscard]] const std::vector<std::byte>& bytes() const { return bytes_; }
    [[nodiscard]] std::vector<std::byte> with_checksum() const
    {
        CodedBytes closed = *this;
        closed.put(bitwise_crc32c(bytes_));
        return closed.bytes_;
    }

private:
    std::vector<std::byte> bytes_;
    std::size_t bit_{0};
};

/// Variable parts of a header: the fixed fields, one box for each index page, region bits.
struct HeaderParts
{
    HeaderFields fields;
    std::vector<IndexPageEntry> entries;
    std::vector<std::uint8_t> region_bits;

    /// Sets `header_bytes` and writes the parts.
    [[nodiscard]] std::vector<std::byte> write()
    {
        fields.header_bytes =
            static_cast<std::uint32_t>(168 + 48 * entries.size() + region_bits.size() + 32 + 4);
        return write_as_is();
    }
    [[nodiscard]] std::vector<std::byte> write_as_is() const
    {
        CodedBytes bytes;
        bytes.put(fields);
        for (const IndexPageEntry& entry : entries)
        {
            bytes.put(entry);
        }
        for (const std::uint8_t bits : region_bits)
        {
            bytes.put(bits);
        }
        return bytes.zeros(32).with_checksum();
    }
};

/// Sound header for `records` records over 4 base vertices and 4 base faces: 16 bits, quanta of
/// 2^-10 m, extents 1000 x 2000 x 3000, regions of 1024 quanta in a grid of 1 x 2 x 3.
[[nodiscard]] inline HeaderParts sound_header(std::uint32_t records)
{
    HeaderParts parts;
    HeaderFields& fields = parts.fields;
    fields.base_vertices = 4;
    fields.base_faces = 4;
    fields.records = records;
    fields.max_depth = records == 0 ? 0 : 9;
    fields.quantum_log2 = -10;
    fields.position_bits = 16;
    fields.extent_quanta = {1'000, 2'000, 3'000};
    fields.origin_m = {0.5, -0.25, 100.0};
    fields.quantisation_m = 1e-4;
    fields.source_faces = 100;
    fields.region_cell_quanta = 1'024;
    fields.region_grid = {1, 2, 3};
    fields.occupied_regions = 3;
    parts.region_bits = {0b0010'1001};
    const std::uint32_t chunks = (records + 63) / 64;
    parts.entries.resize((chunks + 63) / 64);
    for (IndexPageEntry& entry : parts.entries)
    {
        entry.box = {{0, 0, 0}, {1'000, 2'000, 3'000}};
    }
    return parts;
}

/// Header that must be sound.
[[nodiscard]] inline ModelHeader parsed(std::span<const std::byte> bytes)
{
    return ModelHeader::parse(bytes).value();
}

} // namespace tactus::test
