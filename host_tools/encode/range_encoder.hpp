// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/chunk_grammar.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus
{

/// Range encoder, the counterpart of RangeDecoder.
class RangeEncoder
{
public:
    std::uint32_t code_bit(Probability& zero, std::uint32_t bit)
    {
        const std::uint32_t bound = (range_ >> kProbabilityBits) * zero;
        low_ += bit != 0 ? bound : 0U;
        range_ = bit != 0 ? range_ - bound : bound;
        adapt(zero, bit);
        shift_out();
        return bit;
    }
    std::uint32_t code_raw(std::uint32_t bits, std::uint32_t value)
    {
        for (std::uint32_t i = bits; i-- > 0;)
        {
            range_ >>= 1U;
            low_ += ((value >> i) & 1U) != 0 ? range_ : 0U;
            shift_out();
        }
        return value;
    }

    /// Ends the code with the number in the last range that has the most trailing zero bytes, and
    /// omits those bytes.
    [[nodiscard]] std::vector<std::byte> finish()
    {
        const std::uint64_t end = low_ + range_;
        std::uint32_t zeros = 32;
        while (((low_ + (std::uint64_t{1} << zeros) - 1) >> zeros << zeros) >= end)
        {
            zeros -= 8;
        }
        low_ = (low_ + (std::uint64_t{1} << zeros) - 1) >> zeros << zeros;
        carry();
        for (std::uint32_t shift = 32; shift > 0; shift -= 8)
        {
            bytes_.push_back(static_cast<std::byte>(low_ >> (shift - 8)));
        }
        while (!bytes_.empty() && bytes_.back() == std::byte{0})
        {
            bytes_.pop_back();
        }
        return std::move(bytes_);
    }

private:
    void shift_out()
    {
        while (range_ < kRangeLeast)
        {
            carry();
            bytes_.push_back(static_cast<std::byte>(low_ >> 24U));
            low_ = (low_ << 8U) & 0xFFFF'FFFFU;
            range_ <<= 8U;
        }
    }
    void carry()
    {
        if ((low_ >> 32U) != 0)
        {
            std::size_t at = bytes_.size();
            do
            {
                --at;
                bytes_[at] = static_cast<std::byte>(std::to_integer<std::uint32_t>(bytes_[at]) + 1);
            } while (bytes_[at] == std::byte{0});
            low_ &= 0xFFFF'FFFFU;
        }
    }

    std::vector<std::byte> bytes_;
    std::uint64_t low_{0};
    std::uint32_t range_{0xFFFF'FFFFU};
};

} // namespace tactus
