// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <span>
#include <string>
#include <string_view>

// Any thread, except the haptic one: texts allocate.
namespace tactus
{

/// The one of `words` with the least edit distance to `word` (Levenshtein: letters inserted,
/// removed or replaced), for a user's typing error. Empty when none is near.
[[nodiscard]] std::string nearest_word(std::string_view word,
                                       std::span<const std::string_view> words);

} // namespace tactus
