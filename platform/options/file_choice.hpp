// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/options/option_table.hpp"
#include "platform/options/options.hpp"

#include <string>

namespace tactus::hrtc
{

/// Whether the text names a file: a path, or the name of a model's or a scene's file.
[[nodiscard]] bool is_file_name(const std::string& text, const FileReaders& readers);

/// Puts the files that stand on the command line without an option where --model or --scene would,
/// and chooses the transport where --transport doesn't: files when all names are of files, DDS when
/// none is. Empty when all is well, otherwise the line for wrong usage, with the names of the
/// program's other commands where a word is no file.
[[nodiscard]] std::string take_files(Options& options, RawOptions& raw,
                                     const std::string& commands);

} // namespace tactus::hrtc
