// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <functional>
#include <string_view>

namespace tactus
{

/// Runs `body` as main() of a program and returns its exit code. An exception from `body` becomes
/// one line on stderr, after the program's name, and kExitFailed. If memory runs out, `memory_hint`
/// replaces the exception's own text. It states how much memory the program needs, and may be
/// empty.
[[nodiscard]] int run_program(std::string_view name, std::string_view memory_hint,
                              const std::function<int()>& body);

} // namespace tactus
