// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <span>
#include <string>
#include <string_view>

// Any thread, but not the haptic one: texts allocate.
namespace tactus
{

/// The one of `words` that a user who wrote `word` may have meant: the fewest letters have to be
/// put in, left out or exchanged (Levenshtein). Empty when none is near.
[[nodiscard]] std::string nearest_word(std::string_view word,
                                       std::span<const std::string_view> words);

} // namespace tactus
