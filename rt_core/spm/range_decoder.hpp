// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/chunk_grammar.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus
{

/// Binary range decoder with adaptive probabilities (Martin 1979; 12-bit probabilities and 32-bit
/// range as in LZMA). It reads zeros behind the last byte: an encoder omits trailing ones.
class RangeDecoder
{
public:
    explicit RangeDecoder(std::span<const std::byte> bytes) noexcept : bytes_(bytes)
    {
        for (int i = 0; i < 4; ++i)
        {
            code_ = code_ << 8U | next_byte();
        }
    }

    /// Decodes a bit. The second argument is unused; it lets one grammar serve encoder and decoder.
    std::uint32_t code_bit(Probability& zero, std::uint32_t /*value*/ = 0) noexcept
    {
        const std::uint32_t bound = (range_ >> kProbabilityBits) * zero;
        // Branchless: bits are not predictable.
        const std::uint32_t bit = code_ < bound ? 0U : 1U;
        const std::uint32_t if_one = 0U - bit;
        code_ -= bound & if_one;
        range_ = bound + ((range_ - 2 * bound) & if_one);
        adapt(zero, bit);
        refill();
        return bit;
    }
    std::uint32_t code_raw(std::uint32_t bits, std::uint32_t /*value*/ = 0) noexcept
    {
        TACTUS_ASSERT(bits <= 32);
        std::uint32_t value = 0;
        for (; bits > 0; --bits)
        {
            range_ >>= 1U;
            const std::uint32_t bit = code_ < range_ ? 0U : 1U;
            code_ -= range_ & (0U - bit);
            value = value << 1U | bit;
            refill();
        }
        return value;
    }

    /// True if bytes are left that no symbol used.
    [[nodiscard]] bool has_bytes_left() const noexcept { return read_ < bytes_.size(); }

private:
    /// Refills the range, which no bit shrinks below 2^-8 of itself, so one byte is enough.
    void refill() noexcept
    {
        if (range_ < kRangeLeast)
        {
            range_ <<= 8U;
            code_ = code_ << 8U | next_byte();
        }
    }
    std::uint32_t next_byte() noexcept
    {
        return read_ < bytes_.size() ? std::to_integer<std::uint32_t>(bytes_[read_++]) : 0U;
    }

    std::span<const std::byte> bytes_;
    std::size_t read_{0};
    std::uint32_t range_{0xFFFF'FFFFU};
    std::uint32_t code_{0};
};

} // namespace tactus
