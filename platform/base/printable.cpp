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
    const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == 0x7F; };
    std::string result(text);
    std::ranges::replace_if(result, is_control, '?');
    return result;
}

} // namespace tactus
