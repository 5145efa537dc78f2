// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus
{

/// From now on a failed assertion, which is a bug or a call that breaks a promise, says on stderr
/// what failed and where before it stops the process; without a handler it only stops. Does nothing
/// where the program has a handler (set_assert_handler()). At start-up, on one thread.
void print_failed_assertions() noexcept;

} // namespace tactus
