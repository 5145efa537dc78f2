// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/detail/text_cursor.hpp"

#include "transport/base/printable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace tactus::detail
{

namespace
{

bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\f' || c == '\v';
}

bool ends_line(char c)
{
    return c == '\n' || c == '\r';
}

std::string_view without_plus(std::string_view token)
{
    const bool plus = token.size() > 1 && token[0] == '+' && token[1] != '-' && token[1] != '+';
    return plus ? token.substr(1) : token;
}

} // namespace

std::string_view without_byte_order_mark(std::string_view text)
{
    constexpr std::string_view kMark = "\xEF\xBB\xBF";
    return text.starts_with(kMark) ? text.substr(kMark.size()) : text;
}

std::string_view TextCursor::next_token_in_line()
{
    while (at_ < text_.size() && is_blank(text_[at_]))
    {
        ++at_;
    }
    const std::size_t start = at_;
    while (at_ < text_.size() && !is_blank(text_[at_]) && !ends_line(text_[at_]))
    {
        ++at_;
    }
    return text_.substr(start, at_ - start);
}

std::string_view TextCursor::next_token()
{
    std::string_view token = next_token_in_line();
    while (token.empty() && skip_line())
    {
        token = next_token_in_line();
    }
    return token;
}

bool TextCursor::skip_line()
{
    const bool moved = at_ < text_.size();
    while (at_ < text_.size() && !ends_line(text_[at_]))
    {
        ++at_;
    }
    if (at_ < text_.size())
    {
        at_ += text_.substr(at_).starts_with("\r\n") ? 2U : 1U;
        ++line_;
    }
    return moved;
}

Refusal TextCursor::error(const std::string& what) const
{
    return {fmt::format("line {}: {}", line_, what)};
}

std::optional<double> parse_number(std::string_view token)
{
    const std::string_view digits = without_plus(token);
    double value = 0.0;
    const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    const auto read = static_cast<std::size_t>(end - digits.data());
    if (code == std::errc::invalid_argument)
    {
        return std::nullopt;
    }
    if (read != digits.size())
    {
        if (digits[read] != 'd' && digits[read] != 'D')
        {
            return std::nullopt;
        }
        std::string by_e(digits);
        by_e[read] = 'e';
        return parse_number(by_e);
    }
    if (code == std::errc::result_out_of_range)
    {
        const bool tiny = digits.find("e-") != digits.npos || digits.find("E-") != digits.npos;
        return tiny ? 0.0 : std::numeric_limits<double>::infinity();
    }
    return value;
}

std::optional<std::int64_t> parse_integer(std::string_view token)
{
    const std::string_view digits = without_plus(token);
    std::int64_t value = 0;
    const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (!digits.empty() && end == digits.data() + digits.size() && code == std::errc{})
    {
        return value;
    }
    constexpr double kExact = 9007199254740992.0; // 2^53.
    const auto number = parse_number(token);
    return number && std::abs(*number) < kExact && *number == std::trunc(*number)
               ? std::optional(static_cast<std::int64_t>(*number))
               : std::nullopt;
}

std::string no_number(std::string_view token)
{
    return quote(token) + ", not a number" +
           (token.find(',') == token.npos ? "" : "; decimals must have a point, not a comma");
}

std::string lower(std::string_view token)
{
    std::string text(token);
    std::ranges::transform(text, text.begin(),
                           [](char c)
                           { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return text;
}

std::string quote(std::string_view token)
{
    constexpr std::size_t kLongest = 24; // Maximum length, since a file may be one long line.
    return "'" + printable(token, kLongest) + "'";
}

} // namespace tactus::detail
