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

/// Takes files without an option on the command line as values of --model or --scene. Without
/// --transport, chooses the transport: `file` if all names are files, `dds` if none is. Returns the
/// message for wrong usage; empty if there is none. `commands`: names of the program's other
/// commands, for that message.
[[nodiscard]] std::string take_files(Options& options, RawOptions& raw,
                                     const std::string& commands);

} // namespace tactus::hrtc
