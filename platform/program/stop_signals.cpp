// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/program/run_program.hpp"

#include <atomic>
#include <csignal>

namespace tactus
{

namespace
{

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free); // A signal handler sets it.

void handle(int signal, void (*handler)(int)) noexcept
{
    struct sigaction action = {};
    action.sa_handler = handler;
    ::sigaction(signal, &action, nullptr);
}

bool is_ignored(int signal) noexcept
{
    struct sigaction action = {};
    return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

} // namespace

void stop_on_signals() noexcept
{
    for (const int signal : {SIGHUP, SIGINT, SIGQUIT, SIGTERM, SIGXCPU, SIGALRM, SIGUSR1, SIGUSR2})
    {
        if (signal != SIGHUP || !is_ignored(signal))
        {
            handle(signal, [](int) { stop_requested.store(true, std::memory_order_relaxed); });
        }
    }
    handle(SIGPIPE, SIG_IGN);
    handle(SIGXFSZ, SIG_IGN);
}

bool is_stop_requested() noexcept
{
    return stop_requested.load(std::memory_order_relaxed);
}

} // namespace tactus
