// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace tactus
{

static_assert(std::endian::native == std::endian::little,
              "files, wire and pages are little-endian; a big-endian port needs swaps here");

/// Reads little-endian values from bytes that are not trusted. A read past the end returns zero and
/// latches `failed()`; check it once at the end instead of after every value.
class ByteReader
{
public:
    explicit ByteReader(std::span<const std::byte> bytes) noexcept : bytes_(bytes) {}

    template <typename T>
    [[nodiscard]] T read() noexcept
    {
        static_assert(std::is_trivially_copyable_v<T>);
        T value{};
        if (bytes_.size() - at_ < sizeof(T))
        {
            fail();
            return value;
        }
        std::memcpy(&value, bytes_.data() + at_, sizeof(T));
        at_ += sizeof(T);
        return value;
    }

    /// LEB128, at most 5 bytes; a value beyond 32 bits fails.
    [[nodiscard]] std::uint32_t read_varint() noexcept
    {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 35; shift += 7)
        {
            const auto byte = read<std::uint8_t>();
            value |= static_cast<std::uint64_t>(byte & 0x7FU) << shift;
            if ((byte & 0x80U) == 0)
            {
                if (failed_)
                {
                    return 0;
                }
                if (value > 0xFFFF'FFFFU)
                {
                    fail();
                    return 0;
                }
                return static_cast<std::uint32_t>(value);
            }
        }
        fail();
        return 0;
    }

    /// Zig-zag coded LEB128: small magnitudes of either sign are short.
    [[nodiscard]] std::int32_t read_signed_varint() noexcept
    {
        const std::uint32_t coded = read_varint();
        return static_cast<std::int32_t>((coded >> 1U) ^ (~(coded & 1U) + 1U));
    }

    /// The next `count` bytes themselves; empty and failed when there are fewer.
    [[nodiscard]] std::span<const std::byte> read_bytes(std::size_t count) noexcept
    {
        if (bytes_.size() - at_ < count)
        {
            fail();
            return {};
        }
        const auto part = bytes_.subspan(at_, count);
        at_ += count;
        return part;
    }

    [[nodiscard]] bool failed() const noexcept { return failed_; }
    [[nodiscard]] bool at_end() const noexcept { return at_ == bytes_.size(); }
    [[nodiscard]] std::size_t position() const noexcept { return at_; }
    [[nodiscard]] std::size_t remaining() const noexcept { return bytes_.size() - at_; }

private:
    void fail() noexcept
    {
        failed_ = true;
        at_ = bytes_.size();
    }

    std::span<const std::byte> bytes_;
    std::size_t at_{0};
    bool failed_{false};
};

} // namespace tactus
