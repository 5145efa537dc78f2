// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <span>
#include <string>
#include <string_view>

// Any thread except the haptic one: strings allocate.
namespace tactus
{

/// Member of `words` with the least edit distance to `word` (Levenshtein: letters inserted, removed
/// or replaced), to correct a typing error. Empty if all are too far.
[[nodiscard]] std::string nearest_word(std::string_view word,
                                       std::span<const std::string_view> words);

} // namespace tactus
