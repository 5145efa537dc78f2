// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus
{

/// Numbers distinct 32-bit keys 0, 1, 2 ... in the order of first occurrence. Scratch memory that
/// is cleared for each star: open addressing, at most half full, memory kept between uses.
class IndexMap
{
public:
    /// Removes all keys and makes room for `keys_max` distinct keys.
    void reset(std::size_t keys_max)
    {
        size_ = 0;
        mask_ = std::bit_ceil(2 * keys_max + 2) - 1;
        if (slots_.size() <= mask_)
        {
            slots_.resize(mask_ + 1);
        }
        std::fill_n(slots_.begin(), mask_ + 1, Slot{0, kEmpty});
    }

    /// Number of the key; a new key gets the value of `size()` before the call.
    std::uint32_t index_of(std::uint32_t key)
    {
        std::size_t at = (key * 0x9E37'79B1ULL >> 7U) & mask_;
        while (slots_[at].index != kEmpty && slots_[at].key != key)
        {
            at = (at + 1) & mask_;
        }
        if (slots_[at].index == kEmpty)
        {
            slots_[at] = {key, size_++};
        }
        return slots_[at].index;
    }

    [[nodiscard]] std::uint32_t size() const noexcept { return size_; }

private:
    static constexpr std::uint32_t kEmpty = 0xFFFF'FFFFU;

    struct Slot
    {
        std::uint32_t key;
        std::uint32_t index;
    };

    std::vector<Slot> slots_;
    std::size_t mask_{0};
    std::uint32_t size_{0};
};

} // namespace tactus
