// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/detail/text_cursor.hpp"

#include "platform/base/printable.hpp"

#include <fmt/format.h>

#include <charconv>
#include <limits>

namespace tactus::detail
{

namespace
{

bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

std::string_view without_plus(std::string_view token)
{
    const bool plus = token.size() > 1 && token[0] == '+' && token[1] != '-' && token[1] != '+';
    return plus ? token.substr(1) : token;
}

} // namespace

std::string_view TextCursor::next_token_in_line()
{
    while (at_ < text_.size() && is_blank(text_[at_]))
    {
        ++at_;
    }
    const std::size_t start = at_;
    while (at_ < text_.size() && !is_blank(text_[at_]) && text_[at_] != '\n')
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
    const std::size_t end = text_.find('\n', at_);
    if (end == std::string_view::npos)
    {
        const bool moved = at_ < text_.size();
        at_ = text_.size();
        return moved;
    }
    at_ = end + 1;
    ++line_;
    return true;
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
    if (digits.empty() || end != digits.data() + digits.size() ||
        code == std::errc::invalid_argument)
    {
        return std::nullopt;
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
    if (digits.empty() || end != digits.data() + digits.size() || code != std::errc{})
    {
        return std::nullopt;
    }
    return value;
}

std::string quote(std::string_view token)
{
    constexpr std::size_t kLongest = 24; // Of a file that may be one long line.
    return "'" + printable(token, kLongest) + "'";
}

} // namespace tactus::detail
