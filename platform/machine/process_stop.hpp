// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus
{

/// Blocks SIGCONT, so that the continuation of a stopped process stays pending until
/// take_process_stop() takes it. Call on the main thread before it starts others, which inherit the
/// signal mask.
///
/// A stopped process is continued by SIGCONT alone, blocked or not, and the system makes the signal
/// pending before any thread runs again. So a thread that sees its own delay also sees the signal.
void watch_process_stops() noexcept;

/// True if the process was stopped from outside and continued since the last call; false without
/// watch_process_stops(). Two system calls at most, neither of which blocks.
[[nodiscard]] bool take_process_stop() noexcept;

} // namespace tactus
