// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

/// Signals that request the end of a program.
namespace tactus
{

/// Lets SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXCPU, SIGALRM and the two user signals request the
/// program's end, instead of ending it. SIGPIPE and SIGXFSZ are ignored: the write that caused them
/// fails. If SIGHUP is ignored, as by nohup, it stays ignored. Any thread.
void stop_on_signals() noexcept;

/// True if a signal has requested the end since the program began. Any thread, and any signal
/// handler.
[[nodiscard]] bool is_stop_requested() noexcept;

} // namespace tactus
