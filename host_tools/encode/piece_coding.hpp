// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/byte_io.hpp"
#include "rt_core/base/crc32c.hpp"
#include "rt_core/spm/base_mesh.hpp"
#include "rt_core/spm/coded_record.hpp"
#include "rt_core/spm/header.hpp"
#include "rt_core/spm/index_page.hpp"
#include "rt_core/spm/ring_prediction.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace tactus
{

/// Appends little-endian values to a growing buffer; the counterpart of ByteReader.
class ByteWriter
{
public:
    template <typename T>
    void write(const T& value)
    {
        static_assert(std::is_trivially_copyable_v<T>);
        write_bytes(std::as_bytes(std::span<const T, 1>(&value, 1)));
    }

    void write_bytes(std::span<const std::byte> bytes)
    {
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    }

    /// Appends a field of `bits` bits, at most 32, lowest bit first; the counterpart of BitReader.
    void write_bits(std::uint32_t bits, std::uint32_t value)
    {
        window_ |= std::uint64_t{value} << held_;
        for (held_ += bits; held_ >= 8; held_ -= 8)
        {
            bytes_.push_back(static_cast<std::byte>(window_ & 0xFFU));
            window_ >>= 8U;
        }
    }
    /// Fills the last byte with zero bits.
    void end_bits() { write_bits((8 - held_) % 8, 0); }

    /// Appends the CRC-32C of all bytes written so far.
    void write_checksum() { write(crc32c(bytes_)); }

    [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return bytes_; }
    [[nodiscard]] std::vector<std::byte> take() noexcept { return std::move(bytes_); }

private:
    std::vector<std::byte> bytes_;
    std::uint64_t window_{0}; ///< Bits that do not fill a byte yet.
    std::uint32_t held_{0};
};

// Encoders for rt_core's parse functions: each parse function reads the result of its encoder back
// to the same content.

/// Codes the base mesh, `positions` and `faces` in the order of their ids; inverse of
/// parse_base_mesh().
[[nodiscard]] std::vector<std::byte> encode_base_mesh(std::span<const GridPosition> positions,
                                                      std::span<const BaseFace> faces,
                                                      const BaseLayout& layout);

/// Codes the records of one chunk, 1 .. 64, in coder version 3; inverse of parse_chunk().
[[nodiscard]] std::vector<std::byte> encode_chunk(ChunkId id, const ModelCounts& counts,
                                                  std::span<const CodedRecord> records);

/// Codes one box and one entry for each chunk of the page, 1 .. 64; inverse of parse_index_page().
[[nodiscard]] std::vector<std::byte> encode_index_page(IndexPageId id,
                                                       std::span<const InfluenceBox> boxes,
                                                       std::span<const ChunkEntry> entries);

/// Codes a header, with root hash and checksum; inverse of ModelHeader::parse(). The sizes in
/// `fields` must equal those of the spans.
[[nodiscard]] std::vector<std::byte> encode_header(const HeaderFields& fields,
                                                   std::span<const IndexPageEntry> index,
                                                   std::span<const std::byte> region_bits);

} // namespace tactus
