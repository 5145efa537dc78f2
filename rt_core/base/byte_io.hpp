// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"

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

    /// A view of the next `count` bytes; empty, with failed() latched, if fewer are left.
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

/// Reads bit fields, lowest bits first. A read past the end is a bug (asserted).
class BitReader
{
public:
    explicit BitReader(std::span<const std::byte> bytes) noexcept : bytes_(bytes) {}

    /// The next field, of up to 32 bits.
    [[nodiscard]] std::uint32_t read(std::uint32_t bits) noexcept
    {
        TACTUS_ASSERT(bits <= 32);
        while (held_ < bits)
        {
            TACTUS_ASSERT(next_ < bytes_.size());
            window_ |= std::to_integer<std::uint64_t>(bytes_[next_++]) << held_;
            held_ += 8;
        }
        const auto value = static_cast<std::uint32_t>(window_ & ((std::uint64_t{1} << bits) - 1));
        window_ >>= bits;
        held_ -= bits;
        return value;
    }

private:
    std::span<const std::byte> bytes_;
    std::size_t next_{0};
    std::uint64_t window_{0};
    std::uint32_t held_{0};
};

} // namespace tactus
