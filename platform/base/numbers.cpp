// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/base/numbers.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>

namespace tactus
{

std::optional<double> parse_number(std::string_view text)
{
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_whole = error == std::errc{} && end == text.data() + text.size();
    return is_whole && std::abs(value) < 1e300 ? std::optional(value) : std::nullopt;
}

std::optional<std::vector<double>> parse_numbers(std::string_view text)
{
    std::vector<double> numbers;
    for (std::size_t at = 0; at <= text.size();)
    {
        const std::size_t comma = std::min(text.find(',', at), text.size());
        const std::optional<double> number = parse_number(text.substr(at, comma - at));
        if (!number)
        {
            return std::nullopt;
        }
        numbers.push_back(*number);
        at = comma + 1;
    }
    return numbers;
}

} // namespace tactus
