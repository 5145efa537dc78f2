// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

/// How a program that runs until it is told to end hears of that.
namespace tactus
{

/// From now on SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXCPU, SIGALRM and the two user signals ask the
/// program to end instead of ending it. SIGPIPE and SIGXFSZ do nothing: the write that caused them
/// fails. A SIGHUP that is ignored, as by nohup, stays ignored. Any thread.
void stop_on_signals() noexcept;

/// Whether a signal to end has come since the program began. Any thread, and any signal handler.
[[nodiscard]] bool is_stop_requested() noexcept;

} // namespace tactus
