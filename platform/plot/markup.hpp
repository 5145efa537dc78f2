// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace tactus::plot
{

/// Any bytes as text of HTML or SVG, in attributes as well. What is no character of XML, control
/// characters and broken UTF-8 alike, becomes U+FFFD.
[[nodiscard]] std::string escaped(std::string_view text);

/// So many characters of UTF-8 at most, the last an ellipsis when there were more. `most` > 0.
[[nodiscard]] std::string shortened(const std::string& text, std::size_t most);

/// How many characters of UTF-8 there are.
[[nodiscard]] std::size_t characters_of(std::string_view text);

} // namespace tactus::plot
