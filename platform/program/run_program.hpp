// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"

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

/// Writes the text to stdout and flushes it. If the reader is gone or the disk is full, the text is
/// lost and the program goes on.
void print_out(std::string_view text) noexcept;

/// Lets SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXCPU, SIGALRM and the two user signals request the
/// program's end, instead of ending it. SIGPIPE and SIGXFSZ are ignored: the write that caused them
/// fails. If SIGHUP is ignored, as by nohup, it stays ignored. Any thread.
void stop_on_signals() noexcept;

/// True if a signal has requested the end since the program began. Any thread, and any signal
/// handler.
[[nodiscard]] bool is_stop_requested() noexcept;

} // namespace tactus

namespace tactus::hrtc
{

/// Refusal of a result for a run that a signal has ended.
[[nodiscard]] Refusal interruption();

/// Logs `error` as an error of hrtc. Returns the exit code.
int leave_with(const Refusal& error);

} // namespace tactus::hrtc
