// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/base/suggestions.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace tactus
{

namespace
{

std::size_t letters_between(std::string_view one, std::string_view other)
{
    std::vector<std::size_t> row(other.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < one.size(); ++i)
    {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < other.size(); ++j)
        {
            const std::size_t exchanged = diagonal + (one[i] == other[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({exchanged, diagonal + 1, row[j] + 1});
        }
    }
    return row.back();
}

} // namespace

std::string nearest_word(std::string_view word, std::span<const std::string_view> words)
{
    std::string_view nearest;
    std::size_t least = word.size() / 3 + 2;
    for (const std::string_view other : words)
    {
        const std::size_t letters = letters_between(word, other);
        // So few edits keep at least one letter.
        if (letters < std::min(least, other.size()))
        {
            least = letters;
            nearest = other;
        }
    }
    return std::string(nearest);
}

} // namespace tactus
