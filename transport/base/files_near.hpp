// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

// Any thread, except the haptic one: reads a folder.
namespace tactus
{

/// Suggestion for a missing file, to append to a message: "; runs/plate.spm is there" for
/// runs/plate, otherwise a few of the files with that ending in its folder.
[[nodiscard]] std::string files_near(const std::filesystem::path& missing, std::string_view ending);

/// List of files: "a.spm, b.spm and 3 more", or "no .spm".
[[nodiscard]] std::string files_in(const std::filesystem::path& folder, std::string_view ending);

} // namespace tactus
