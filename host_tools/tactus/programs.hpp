// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <sys/types.h>
#include <vector>

// Other programs of Tactus, which lie in the folder of this one. One thread.
namespace tactus::front
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

} // namespace tactus::front
