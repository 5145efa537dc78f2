// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/limits.hpp"

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace tactus::hrtc
{

/// Set of the models that have a property at present, for instance a lost server. One thread
/// writes, any thread reads. Accesses are relaxed: they order no other data, and a reader may see
/// the changes of some models before those of others.
class ModelMarks
{
public:
    void set(std::size_t model, bool is_so) noexcept
    {
        const std::uint64_t bit = std::uint64_t{1} << model % 64;
        std::atomic<std::uint64_t>& word = words_[model / 64];
        const std::uint64_t others = word.load(std::memory_order_relaxed) & ~bit;
        word.store(others | (is_so ? bit : 0), std::memory_order_relaxed);
    }

    [[nodiscard]] bool has(std::size_t model) const noexcept
    {
        return (words_[model / 64].load(std::memory_order_relaxed) >> model % 64 & 1U) != 0;
    }
    /// True if `matters(model)` is true for at least one model of the set.
    template <typename Matters>
    [[nodiscard]] bool any_of(const Matters& matters) const noexcept
    {
        for (std::size_t i = 0; i < words_.size(); ++i)
        {
            for (std::uint64_t left = words_[i].load(std::memory_order_relaxed); left != 0;
                 left &= left - 1)
            {
                if (matters(64 * i + static_cast<std::size_t>(std::countr_zero(left))))
                {
                    return true;
                }
            }
        }
        return false;
    }

private:
    std::array<std::atomic<std::uint64_t>, (kMaxModels + 63) / 64> words_{};
};

} // namespace tactus::hrtc
