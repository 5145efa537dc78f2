// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

/// How a program that runs until it is told to end hears of that.
namespace tactus
{

/// From now on SIGINT and SIGTERM ask the program to end instead of ending it. Any thread.
void stop_on_signals() noexcept;

/// Whether one has come since the program began. Any thread, and any signal handler.
[[nodiscard]] bool is_stop_requested() noexcept;

} // namespace tactus
