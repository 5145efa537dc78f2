// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus
{

/// Installs a handler that prints a failed assertion and its place on stderr before the process
/// stops, unless set_assert_handler() has installed another. An assertion fails for a bug or a
/// violated precondition. Call it at start-up, on one thread.
void print_failed_assertions() noexcept;

} // namespace tactus
