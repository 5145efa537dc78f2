// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/base/printable.hpp"

#include <algorithm>
#include <array>
#include <utility>

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

namespace
{

using Range = std::pair<std::string_view, std::string_view>;

/// Ranges of characters, first and last, for which is_letter() is false.
constexpr std::array<Range, 20> kNoLetters{{
    {"\u0080", "\u00A9"}, // Controls, blanks and signs of Latin-1, except for its three letters.
    {"\u00AB", "\u00B4"}, {"\u00B6", "\u00B9"},         {"\u00BB", "\u00BF"},
    {"\u034F", "\u034F"}, {"\u061C", "\u061C"},         {"\u115F", "\u1160"},
    {"\u1680", "\u1680"}, {"\u17B4", "\u17B5"},         {"\u180B", "\u180F"},
    {"\u2000", "\u206F"}, // Blanks, dashes, quotation marks, joiners and direction marks.
    {"\u2800", "\u2800"}, {"\u3000", "\u3000"},         {"\u3164", "\u3164"},
    {"\uE000", "\uF8FF"}, // Private use.
    {"\uFE00", "\uFE0F"}, {"\uFEFF", "\uFEFF"},         {"\uFFA0", "\uFFA0"},
    {"\uFFF0", "\uFFFF"}, {"\U000E0000", "\U0010FFFF"},
}};

} // namespace

std::size_t character_bytes(std::string_view text) noexcept
{
    if (text.empty())
    {
        return 0;
    }
    const auto byte = [text](std::size_t i)
    { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
    const unsigned first = byte(0);
    const std::size_t count = first < 0x80                     ? 1
                              : first >= 0xC2 && first < 0xE0  ? 2
                              : first >= 0xE0 && first < 0xF0  ? 3
                              : first >= 0xF0 && first <= 0xF4 ? 4
                                                               : 0;
    for (std::size_t i = 1; i < count; ++i)
    {
        // The limits of the second byte also exclude overlong forms and invalid characters.
        const unsigned least = i > 1 ? 0x80 : first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
        const unsigned most = i > 1 ? 0xBF : first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
        if (byte(i) < least || byte(i) > most)
        {
            return 0;
        }
    }
    return count;
}

std::string_view whole_characters(std::string_view text, std::size_t longest) noexcept
{
    std::size_t end = std::min(longest, text.size());
    if (end < text.size())
    {
        // A character cut by the end begins at most three bytes before it.
        for (std::size_t begin = end - std::min<std::size_t>(end, 3); begin < end; ++begin)
        {
            if (character_bytes(text.substr(begin)) > end - begin)
            {
                end = begin;
            }
        }
    }
    return text.substr(0, end);
}

bool is_letter(std::string_view character) noexcept
{
    const std::size_t bytes = character_bytes(character);
    return bytes > 1 && bytes == character.size() &&
           std::ranges::none_of(
               kNoLetters,
               [character](const Range& range) { // UTF-8 sorts like the characters.
                   return character >= range.first && character <= range.second;
               });
}

bool is_printable_line(std::string_view text)
{
    return printable_line(text) == text;
}

} // namespace tactus
