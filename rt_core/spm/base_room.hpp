// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/limits.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace tactus
{

/// Hands out cells of the base meshes' memory: each resident streamed model has one range. Haptic
/// thread; at most kMaxModels steps a call.
class BaseRoom
{
public:
    BaseRoom() noexcept = default;
    explicit BaseRoom(std::uint32_t cells) noexcept : cells_(cells) {}

    /// Takes the lowest free range of `count` cells and returns its first cell; none if no gap is
    /// that long.
    [[nodiscard]] std::optional<std::uint32_t> try_take(std::uint32_t count) noexcept
    {
        TACTUS_ASSERT(count > 0);
        std::uint32_t first = 0;
        std::uint32_t at = 0;
        for (; at < taken_.size() && taken_[at].first - first < count; ++at)
        {
            first = taken_[at].end;
        }
        if (taken_.full() || cells_ - first < count)
        {
            return std::nullopt;
        }
        taken_.push_back({first, first + count});
        std::rotate(taken_.begin() + at, taken_.end() - 1, taken_.end());
        used_ += count;
        return first;
    }

    /// Returns a range that try_take() gave.
    void give_back(std::uint32_t first) noexcept
    {
        auto* const range = std::ranges::find(taken_, first, &Range::first);
        TACTUS_ASSERT(range != taken_.end());
        used_ -= range->end - range->first;
        std::rotate(range, range + 1, taken_.end());
        (void)taken_.pop_back();
    }

    [[nodiscard]] std::uint32_t used() const noexcept { return used_; }
    [[nodiscard]] std::uint32_t capacity() const noexcept { return cells_; }

private:
    struct Range
    {
        std::uint32_t first{0};
        std::uint32_t end{0};
    };

    std::uint32_t cells_{0};
    std::uint32_t used_{0};
    StaticVector<Range, kMaxModels> taken_; ///< Sorted by `first`.
};

} // namespace tactus
