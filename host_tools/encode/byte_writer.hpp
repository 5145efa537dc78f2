// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/byte_io.hpp"
#include "rt_core/base/crc32c.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace tactus
{

/// Appends little-endian values to a growing buffer: the writing side of ByteReader.
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

    /// LEB128: seven bits a byte, low ones first.
    void write_varint(std::uint32_t value)
    {
        for (; value >= 0x80U; value >>= 7U)
        {
            bytes_.push_back(static_cast<std::byte>((value & 0x7FU) | 0x80U));
        }
        bytes_.push_back(static_cast<std::byte>(value));
    }

    /// Zig-zag coded, so that small magnitudes of either sign are short.
    void write_signed_varint(std::int32_t value)
    {
        const auto bits = static_cast<std::uint32_t>(value);
        write_varint((bits << 1U) ^ (value < 0 ? 0xFFFF'FFFFU : 0U));
    }

    /// Closes a piece: the CRC-32C of all that was written so far.
    void write_checksum() { write(crc32c(bytes_)); }

    [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return bytes_; }
    [[nodiscard]] std::vector<std::byte> take() noexcept { return std::move(bytes_); }

private:
    std::vector<std::byte> bytes_;
};

} // namespace tactus
