// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus
{

/// Keeps the signal that continues a stopped process until take_process_stop() takes it. Main
/// thread, before it starts others, which inherit that.
///
/// A stopped process is continued by SIGCONT alone, blocked or not, and the system makes the signal
/// pending before any thread runs again. So no thread can see its own delay before the reason.
void watch_process_stops() noexcept;

/// True if the process was stopped from outside and continued since the last call; false without
/// watch_process_stops(). Two system calls at most, neither of which blocks.
[[nodiscard]] bool take_process_stop() noexcept;

} // namespace tactus
