// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_view/feed_sender.hpp"

#include "host_tools/spm_view/feed.hpp"

#include <span>
#include <string>
#include <utility>

namespace tactus::view
{

Result<FeedSender, Refusal> FeedSender::open(const udp::Endpoint& to)
{
    const bool is_loopback = to.address >> 24U == 127U;
    auto socket = udp::Socket::open(is_loopback ? "127.0.0.1" : "0.0.0.0", 0);
    if (!socket)
    {
        return Refusal{"--feed-udp: " + socket.error().text};
    }
    return FeedSender(std::move(socket).value(), to);
}

void FeedSender::send(const Snapshot& snapshot)
{
    std::map<dds::ControllerId, std::uint64_t> sent;
    for (const LiveController& controller : snapshot.controllers)
    {
        const dds::WatchedController& told = controller.told;
        sent[told.id] = told.serial;
        if (const auto last = sent_.find(told.id);
            last != sent_.end() && last->second == told.serial)
        {
            continue;
        }
        for (const std::string& datagram : feed_datagrams(controller))
        {
            static_cast<void>(socket_.send(std::as_bytes(std::span(datagram)), to_));
        }
    }
    sent_ = std::move(sent); // Without controllers that are gone.
}

} // namespace tactus::view
