// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/hrtc/host_topics.hpp"
#include "transport/courier.hpp"
#include "transport/served_model.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace tactus::hrtc
{

/// Runs the couriers of all models on one thread of ordinary priority, a few thousand rounds a
/// second. Start it before the haptic thread: threads inherit policy and processor. When a host
/// goes away or comes back, the model's link says so; the loop goes on with what is resident.
class TransportThread
{
public:
    /// Couriers and models must outlive the thread; nobody else touches them or the models' links
    /// while it runs.
    /// `topics` has its turn after each round of the couriers; it may be none.
    TransportThread(std::vector<std::unique_ptr<Courier>>& couriers,
                    const std::vector<ServedModel>& models, HostTopics* topics);
    TransportThread(const TransportThread&) = delete;
    TransportThread& operator=(const TransportThread&) = delete;
    ~TransportThread() { stop(); }

    /// Waits for the present round to end. No effect the second time.
    void stop();

    /// Any thread: whether some model's host went away since the start.
    [[nodiscard]] bool host_was_lost() const noexcept { return host_was_lost_.load(); }
    /// Any thread: one bit a model, in order, whose host is gone now.
    [[nodiscard]] const std::atomic<std::uint32_t>& hosts_gone() const noexcept
    {
        return hosts_gone_;
    }

private:
    void run();
    void watch_hosts();

    std::vector<std::unique_ptr<Courier>>& couriers_;
    const std::vector<ServedModel>& models_;
    HostTopics* topics_;
    std::atomic<bool> host_was_lost_{false};
    std::atomic<std::uint32_t> hosts_gone_{0}; ///< Relaxed: it orders nothing else.
    std::atomic<bool> stopped_{false};
    std::thread thread_;
};

} // namespace tactus::hrtc
