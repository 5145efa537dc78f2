// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <string>
#include <string_view>

namespace tactus::plot
{

/// Any bytes as text of HTML or SVG, in attributes as well. What is no character of XML, control
/// characters and broken UTF-8 alike, becomes U+FFFD.
[[nodiscard]] std::string escaped(std::string_view text);

} // namespace tactus::plot
