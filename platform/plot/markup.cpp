// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plot/markup.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace tactus::plot
{

namespace
{

constexpr std::string_view kReplacement = "\uFFFD";

bool continues(char c)
{
    return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

/// Number of bytes of the character that starts here; 0 if XML has no such character.
std::size_t character_length(std::string_view text)
{
    const auto first = static_cast<unsigned char>(text[0]);
    if (first < 0x80)
    {
        const bool is_text = first >= 0x20 || first == '\t' || first == '\n';
        return is_text && first != 0x7F ? 1 : 0;
    }
    const std::size_t length = first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
    if (length == 0 || first > 0xF4 || text.size() < length ||
        !std::all_of(text.begin() + 1, text.begin() + static_cast<std::ptrdiff_t>(length),
                     continues))
    {
        return 0;
    }
    std::uint32_t code = first & (0x7FU >> length);
    for (const char c : text.substr(1, length - 1))
    {
        code = (code << 6U) | (static_cast<unsigned char>(c) & 0x3FU);
    }
    constexpr std::array<std::uint32_t, 5> kLeast{0, 0, 0x80, 0x800, 0x1'0000};
    const bool is_surrogate = code >= 0xD800 && code <= 0xDFFF;
    const bool is_character =
        code >= 0xA0 && !is_surrogate && code <= 0x10'FFFF && code != 0xFFFE && code != 0xFFFF;
    return is_character && code >= kLeast[length] ? length : 0;
}

} // namespace

std::string escaped(std::string_view text)
{
    std::string result;
    while (!text.empty())
    {
        const std::size_t length = character_length(text);
        switch (length == 0 ? '\0' : text[0])
        {
        case '\0':
            result += kReplacement;
            break;
        case '&':
            result += "&amp;";
            break;
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        case '"':
            result += "&quot;";
            break;
        case '\'':
            result += "&#39;";
            break;
        default:
            result += text.substr(0, length);
        }
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return result;
}

} // namespace tactus::plot
