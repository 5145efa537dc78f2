// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/base/printable.hpp"

#include <algorithm>

namespace tactus
{

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
    for (std::size_t i = 0; i < text.size(); ++i)
    {
        const auto byte = static_cast<unsigned char>(text[i]);
        const auto next = static_cast<unsigned char>(i + 1 < text.size() ? text[i + 1] : 0);
        const bool is_late_control = byte == 0xC2 && next >= 0x80 && next < 0xA0; // As UTF-8.
        result += byte < ' ' || byte == 0x7F || is_late_control ? '?' : text[i];
        i += is_late_control ? 1 : 0;
    }
    return result;
}

} // namespace tactus
