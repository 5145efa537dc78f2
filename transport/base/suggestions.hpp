// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

// Any thread except the haptic one: reads a folder.
namespace tactus
{

/// Suggestion to append to a message about a missing file: "; runs/plate.spm is there" if
/// runs/plate is missing; otherwise files of its folder that end in `ending`.
[[nodiscard]] std::string files_near(const std::filesystem::path& missing, std::string_view ending);

/// List of a folder's files that end in `ending`: "a.spm, b.spm and 3 more", or "no .spm".
[[nodiscard]] std::string files_in(const std::filesystem::path& folder, std::string_view ending);

/// Member of `words` with the least edit distance to `word` (Levenshtein: letters inserted, removed
/// or replaced), to correct a typing error. Empty if all are too far.
[[nodiscard]] std::string nearest_word(std::string_view word,
                                       std::span<const std::string_view> words);

} // namespace tactus
