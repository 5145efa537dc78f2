// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <optional>
#include <string_view>

namespace tactus
{

/// Reads all of `text` as a finite number; none when it is anything else.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

} // namespace tactus
