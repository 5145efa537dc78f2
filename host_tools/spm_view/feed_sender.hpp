// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/spm_view/live_state.hpp"
#include "platform/devices/udp/socket.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>
#include <map>
#include <utility>

namespace tactus::view
{

/// Sends the feed as datagrams to one address (docs/feed.md). One thread; never waits.
class FeedSender
{
public:
    /// Opens the socket. `to` may be an address of another machine.
    [[nodiscard]] static Result<FeedSender, Refusal> open(const udp::Endpoint& to);

    /// Sends the states of controllers that are newer than the last ones sent. Datagrams that the
    /// system refuses are lost.
    void send(const Snapshot& snapshot);

private:
    FeedSender(udp::Socket socket, const udp::Endpoint& to) : socket_(std::move(socket)), to_(to) {}

    udp::Socket socket_;
    udp::Endpoint to_;
    std::map<dds::ControllerId, std::uint64_t> sent_; ///< Serials of the last states sent.
};

} // namespace tactus::view
