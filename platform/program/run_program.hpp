// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <functional>
#include <string_view>

namespace tactus
{

/// The main() of every program: returns the exit code that `body` returns. An exception that leaves
/// `body` becomes one line on stderr, behind the program's name, and kExitFailed.
/// `memory_hint`, when it isn't empty, tells how much memory the program needs: it takes the place
/// of the exception's own words when memory runs out.
[[nodiscard]] int run_program(std::string_view name, std::string_view memory_hint,
                              const std::function<int()>& body);

} // namespace tactus
