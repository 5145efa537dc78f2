// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/program/command_line.hpp"
#include "transport/base/refusal.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <sys/types.h>
#include <variant>
#include <vector>

// Other programs of Tactus, which lie in the folder of this one. One thread.
namespace tactus::tactus_program
{

/// Fault of a program that can't be started; empty if it can.
[[nodiscard]] std::optional<Refusal> fault_of_program(std::string_view name);

/// Replaces this process by the program. Returns the reason if that fails.
[[nodiscard]] Refusal become(std::string_view name, std::vector<std::string> arguments);

/// Starts the program, which gets SIGTERM if this process ends first. Returns its process; -1 after
/// a line on stderr if there is none.
[[nodiscard]] pid_t start(std::string_view name, std::vector<std::string> arguments);

/// Waits for the end of a process of start() and returns its exit code; kExitFailed without one. A
/// request to stop this process is passed on.
[[nodiscard]] int wait_for(pid_t process);

/// Runs `tactus touch`: builds a mesh's model if needed, shows it in a browser and touches it.
/// `argv[0]` is the command's name. Returns the exit code.
[[nodiscard]] int touch(int argc, char** argv);

/// Path of the mesh's model as spm_build makes it with these options, or an exit code after a line
/// on stderr. The model is KEY/NAME.spm in the folder .tactus beside the mesh or, if that can't be
/// written, in $XDG_CACHE_HOME/tactus. KEY is a hash of the mesh's content, the options and the
/// version. A damaged model is built again.
[[nodiscard]] std::variant<std::string, int> cached_model(const CommandLine& line,
                                                          const std::string& mesh,
                                                          const std::vector<std::string>& options);

} // namespace tactus::tactus_program
