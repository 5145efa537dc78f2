// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

// Any thread, except the haptic one: it allocates.
namespace tactus
{

/// A list of values for each number from 0 on, such as the faces around each vertex; all lists are
/// in one array.
class IndexLists
{
public:
    IndexLists() = default;
    /// `for_each_pair` calls its argument with pairs of a number below `numbers` and a value for
    /// that number's list. It is called twice and must give the same pairs. A list keeps their
    /// order.
    template <typename ForEachPair>
    IndexLists(std::size_t numbers, const ForEachPair& for_each_pair) : start_(numbers + 1, 0)
    {
        for_each_pair([this](std::uint32_t number, std::uint32_t) { ++start_[number + 1]; });
        std::partial_sum(start_.begin(), start_.end(), start_.begin());
        values_.resize(start_.back());
        std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
        for_each_pair([&](std::uint32_t number, std::uint32_t value)
                      { values_[next[number]++] = value; });
    }

    [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t number) const noexcept
    {
        return std::span(values_).subspan(start_[number], start_[number + 1] - start_[number]);
    }

private:
    std::vector<std::size_t> start_;
    std::vector<std::uint32_t> values_;
};

} // namespace tactus
