// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <iterator>
#include <utility>
#include <vector>

// Any thread: a value; set() allocates.
namespace tactus::view
{

/// A value as a function of the frame, stored as its changes.
template <typename T, typename Equal = std::equal_to<T>>
class Timeline
{
public:
    /// Sets the value from `frame` on. Frames must not decrease from call to call.
    void set(std::uint64_t frame, const T& value)
    {
        if (steps_.empty() || !Equal{}(steps_.back().second, value))
        {
            steps_.emplace_back(frame, value);
        }
    }
    /// Value at a frame; null before the first set().
    [[nodiscard]] const T* at(std::uint64_t frame) const
    {
        const auto next =
            std::ranges::upper_bound(steps_, frame, {}, &std::pair<std::uint64_t, T>::first);
        return next == steps_.begin() ? nullptr : &std::prev(next)->second;
    }

private:
    std::vector<std::pair<std::uint64_t, T>> steps_;
};

} // namespace tactus::view
