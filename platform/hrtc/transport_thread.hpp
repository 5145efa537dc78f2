// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/hrtc/host_topics.hpp"
#include "platform/hrtc/hosts_gone.hpp"
#include "transport/courier.hpp"
#include "transport/served_model.hpp"

#include <atomic>
#include <thread>
#include <vector>

namespace tactus::hrtc
{

/// Runs the courier on one thread of ordinary priority, a few thousand rounds a
/// second. Start it before the haptic thread: threads inherit policy and processor. When a host
/// goes away or comes back, the model's link says so; the loop goes on with what is resident.
class TransportThread
{
public:
    /// Courier and models must outlive the thread; nobody else touches them or the models' links
    /// while it runs. `topics` has its turn after each round of the courier; it may be none.
    TransportThread(Courier& courier, const std::vector<ServedModel>& models, HostTopics* topics);
    TransportThread(const TransportThread&) = delete;
    TransportThread& operator=(const TransportThread&) = delete;
    ~TransportThread() { stop(); }

    /// Waits for the present round to end. No effect the second time.
    void stop();

    /// Any thread: whether some model's host went away since the start.
    [[nodiscard]] bool host_was_lost() const noexcept { return host_was_lost_.load(); }
    [[nodiscard]] const HostsGone& hosts_gone() const noexcept { return hosts_gone_; }

private:
    void run();
    void watch_hosts();

    Courier& courier_;
    const std::vector<ServedModel>& models_;
    HostTopics* topics_;
    std::atomic<bool> host_was_lost_{false};
    HostsGone hosts_gone_;
    std::atomic<bool> stopped_{false};
    std::thread thread_;
};

} // namespace tactus::hrtc
