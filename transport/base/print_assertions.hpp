// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus
{

/// Installs a handler that prints a failed assertion and its place on stderr before the process
/// stops; without a handler the process only stops. A failed assertion is a bug or a call that
/// breaks a promise. Has no effect if the program has a handler (set_assert_handler()). Call it at
/// start-up, on one thread.
void print_failed_assertions() noexcept;

} // namespace tactus
