// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"
#include "rt_core/math/aabb.hpp"

#include <cstddef>
#include <limits>
#include <span>
#include <utility>

// Any thread: a function of its argument alone; it does not wait or allocate.
namespace tactus
{

/// Indices, the lower one first, of the two of at least two boxes (asserted) whose union has the
/// least sum of sides. Unlike the volume, that sum also orders flat boxes. Of several such pairs,
/// the first one. The time is quadratic.
[[nodiscard]] constexpr std::pair<std::size_t, std::size_t>
smallest_union(std::span<const Aabb> boxes) noexcept
{
    TACTUS_ASSERT(boxes.size() >= 2);
    std::pair<std::size_t, std::size_t> pair{0, 1};
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < boxes.size(); ++i)
    {
        for (std::size_t k = i + 1; k < boxes.size(); ++k)
        {
            Aabb both = boxes[i];
            both.add(boxes[k]);
            double sum = 0.0;
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                sum += static_cast<double>(both.high[axis]) - static_cast<double>(both.low[axis]);
            }
            if (sum < least)
            {
                least = sum;
                pair = {i, k};
            }
        }
    }
    return pair;
}

} // namespace tactus
