// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/program/command_line.hpp"

#include <string>
#include <variant>
#include <vector>

namespace tactus::front
{

/// Path of the mesh's model as spm_build makes it with these options, or an exit code after a line
/// on stderr. The model is KEY/NAME.spm in the folder .tactus beside the mesh or, if that can't be
/// written, in $XDG_CACHE_HOME/tactus. KEY is a hash of the mesh's content, the options and the
/// version. A damaged model is built again.
[[nodiscard]] std::variant<std::string, int> cached_model(const CommandLine& line,
                                                          const std::string& mesh,
                                                          const std::vector<std::string>& options);

} // namespace tactus::front
