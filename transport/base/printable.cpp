// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/base/printable.hpp"

#include "transport/base/utf8.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// True if a terminal executes the UTF-8 character instead of showing it.
bool steers(std::string_view character) noexcept
{
    const auto is_between = [character](std::string_view first, std::string_view last)
    { return character.size() == first.size() && character >= first && character <= last; };
    return is_between(std::string_view("\0", 1), "\x1F") || character == "\x7F" ||
           is_between("\u0080", "\u009F") || character == "\u061C" ||
           is_between("\u200E", "\u200F") || is_between("\u2028", "\u202E") ||
           is_between("\u2066", "\u2069");
}

} // namespace

std::string printable(std::string_view text, std::size_t longest)
{
    const std::string_view shown = whole_characters(text, longest);
    return printable_line(shown) + (shown.size() < text.size() ? "..." : "");
}

std::string printable_line(std::string_view text)
{
    std::string result;
    while (!text.empty())
    {
        const std::size_t bytes = character_bytes(text);
        const std::string_view character = text.substr(0, std::max<std::size_t>(bytes, 1));
        result += bytes == 0 || steers(character) ? "?" : character;
        text.remove_prefix(character.size());
    }
    return result;
}

bool is_printable_line(std::string_view text)
{
    return printable_line(text) == text;
}

} // namespace tactus
