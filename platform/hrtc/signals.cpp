// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/signals.hpp"

#include <atomic>
#include <csignal>

namespace tactus::hrtc
{

namespace
{

std::atomic<bool> interrupted{false};

void on_signal(int /*signal*/)
{
    interrupted.store(true);
}

} // namespace

void install_signal_handlers()
{
    struct sigaction action
    {
    };
    action.sa_handler = on_signal;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

bool was_interrupted() noexcept
{
    return interrupted.load();
}

} // namespace tactus::hrtc
