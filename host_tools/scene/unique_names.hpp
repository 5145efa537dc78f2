// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus
{

/// What a modeller calls a thing, as a name that the wire and every file system take: each
/// character that no valid name has becomes '_', a blank, too, and it is cut to at most 63 bytes.
/// Empty stays empty.
[[nodiscard]] std::string plain_name(std::string_view given);

/// Makes names different, in their order: the first of equal ones keeps the name, each further one
/// gets "-2", "-3" and so on, the first of these that nothing here is called. Names are valid
/// (is_valid_name), and so are the results. n log n.
[[nodiscard]] std::vector<std::string> unique_names(std::span<const std::string> names);

} // namespace tactus
