// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <optional>
#include <string_view>

namespace tactus
{

/// Finite number that the whole `text` represents; none for any other text.
[[nodiscard]] std::optional<double> parse_number(std::string_view text);

} // namespace tactus
