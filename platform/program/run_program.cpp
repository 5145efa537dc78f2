// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/program/run_program.hpp"

#include "platform/program/command_line.hpp"
#include "transport/base/exit_codes.hpp"
#include "transport/base/program_log.hpp"

#include <atomic>
#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

namespace tactus
{

int run_program(std::string_view name, std::string_view memory_hint,
                const std::function<int()>& body)
{
    try
    {
        return body();
    }
    catch (const std::bad_alloc& error)
    {
        log_message(LogLevel::error, name,
                    memory_hint.empty() ? error.what()
                                        : "not enough memory; " + std::string(memory_hint));
    }
    catch (const std::exception& error)
    {
        log_message(LogLevel::error, name, error.what());
    }
    return kExitFailed;
}

void print_out(std::string_view text) noexcept
{
    static_cast<void>(std::fwrite(text.data(), 1, text.size(), stdout));
    static_cast<void>(std::fflush(stdout));
}

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

namespace tactus::hrtc
{

Refusal interruption()
{
    return {"interrupted; there is no verdict"};
}

int leave_with(const Refusal& error)
{
    log_message(LogLevel::error, "hrtc", error.text);
    return error.is_usage ? kExitUsage : kExitFailed;
}

} // namespace tactus::hrtc
