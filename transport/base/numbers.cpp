// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/base/numbers.hpp"

#include <charconv>
#include <cmath>

namespace tactus
{

std::optional<double> parse_number(std::string_view text)
{
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_whole = error == std::errc{} && end == text.data() + text.size();
    return is_whole && std::abs(value) < 1e300 ? std::optional(value) : std::nullopt;
}

} // namespace tactus
