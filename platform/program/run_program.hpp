// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <functional>
#include <string_view>

namespace tactus
{

/// Runs `body` as main() of a program and returns its exit code. An exception from `body` is
/// printed as one line on stderr, after the program's name; the exit code is then kExitFailed. If
/// memory runs out, `memory_hint` replaces the exception's text: it states how much memory the
/// program needs, and may be empty.
[[nodiscard]] int run_program(std::string_view name, std::string_view memory_hint,
                              const std::function<int()>& body);

} // namespace tactus
