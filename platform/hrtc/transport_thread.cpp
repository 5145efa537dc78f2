// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/transport_thread.hpp"

#include "platform/posix/posix_clock.hpp"

#include <chrono>

namespace tactus::hrtc
{

namespace
{

/// Pause between two rounds: a wish waits this long at most before it leaves.
constexpr std::chrono::microseconds kPause{300};

} // namespace

TransportThread::TransportThread(std::vector<std::unique_ptr<Courier>>& couriers,
                                 const std::vector<ServedModel>& models)
    : couriers_(couriers), models_(models), thread_([this] { run(); })
{
}

void TransportThread::stop()
{
    stopped_.store(true);
    if (thread_.joinable())
    {
        thread_.join();
    }
}

void TransportThread::run()
{
    const PosixClock clock;
    while (!stopped_.load())
    {
        for (const std::unique_ptr<Courier>& courier : couriers_)
        {
            courier->step(clock.now().ns);
        }
        watch_hosts();
        std::this_thread::sleep_for(kPause);
    }
}

void TransportThread::watch_hosts()
{
    for (const ServedModel& model : models_)
    {
        if (model.link->state() == LinkState::host_gone)
        {
            host_was_lost_.store(true);
        }
    }
}

} // namespace tactus::hrtc
