// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/options/option_table.hpp"
#include "platform/options/options.hpp"

#include <string>

namespace tactus::hrtc
{

/// True if the text is a path, or the name of a model or scene file.
[[nodiscard]] bool is_file_name(const std::string& text, const FileReaders& readers);

/// Treats files without an option on the command line as values of --model or --scene. Without
/// --transport, chooses it: files if all names are files, DDS if none is. Returns the line for
/// wrong usage, empty if there is none. If a word is no file, the line lists the program's other
/// `commands`.
[[nodiscard]] std::string take_files(Options& options, RawOptions& raw,
                                     const std::string& commands);

} // namespace tactus::hrtc
