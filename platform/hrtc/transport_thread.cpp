// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/transport_thread.hpp"

#include "platform/posix/posix_clock.hpp"

#include <chrono>
#include <cstddef>

namespace tactus::hrtc
{

namespace
{

/// Pause between two rounds: a wish waits this long at most before it leaves.
constexpr std::chrono::microseconds kPollPause{300};

} // namespace

TransportThread::TransportThread(Courier& courier, const std::vector<ServedModel>& models,
                                 HostTopics* topics)
    : courier_(courier), models_(models), topics_(topics), thread_([this] { run(); })
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
        courier_.step(clock.now().ns);
        watch_hosts();
        if (topics_ != nullptr)
        {
            topics_->step(clock.now());
        }
        std::this_thread::sleep_for(kPollPause);
    }
}

void TransportThread::watch_hosts()
{
    for (std::size_t i = 0; i < models_.size(); ++i)
    {
        const bool is_gone = models_[i].link->state() == LinkState::host_gone;
        hosts_gone_.set(i, is_gone);
        host_was_lost_.store(host_was_lost_.load() || is_gone);
    }
}

} // namespace tactus::hrtc
