// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/cli/stop_signals.hpp"

#include <atomic>
#include <csignal>

namespace tactus
{

namespace
{

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free); // Set in a signal handler.

} // namespace

void stop_on_signals() noexcept
{
    struct sigaction action = {};
    action.sa_handler = [](int) { stop_requested.store(true, std::memory_order_relaxed); };
    ::sigaction(SIGINT, &action, nullptr);
    ::sigaction(SIGTERM, &action, nullptr);
}

bool is_stop_requested() noexcept
{
    return stop_requested.load(std::memory_order_relaxed);
}

} // namespace tactus
