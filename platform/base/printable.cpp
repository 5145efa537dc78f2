// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/base/printable.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// How many bytes the character has that begins the text; 0: it is no UTF-8 (RFC 3629).
std::size_t character_bytes(std::string_view text) noexcept
{
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
        // The second one also says whether fewer bytes would have done, and what is none.
        const unsigned least = i > 1 ? 0x80 : first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
        const unsigned most = i > 1 ? 0xBF : first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
        if (byte(i) < least || byte(i) > most)
        {
            return 0;
        }
    }
    return count;
}

/// Whether the character, which is one of UTF-8, is obeyed and not seen.
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
    std::string result(text.substr(0, longest));
    std::ranges::replace_if(
        result, [](char c) { return !is_printable(c); }, '?');
    return text.size() > longest ? result + "..." : result;
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

} // namespace tactus
