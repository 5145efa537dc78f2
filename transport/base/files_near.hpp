// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

// Any thread, but not the haptic one: reads a folder.
namespace tactus
{

/// Where no file is: what the user may have meant, to stand behind the reason. "; runs/plate.spm is
/// there" of runs/plate, else the files with that ending in its folder, at most a few.
[[nodiscard]] std::string files_near(const std::filesystem::path& missing, std::string_view ending);

/// "a.spm, b.spm and 3 more", or "no .spm".
[[nodiscard]] std::string files_in(const std::filesystem::path& folder, std::string_view ending);

} // namespace tactus
