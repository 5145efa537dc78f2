// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/spm_view/live_state.hpp"
#include "platform/devices/udp/socket.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

// Feed for graphics programs (docs/feed.md): one list of fields, as JSON and as datagrams. Any
// thread: results depend on the arguments alone; they allocate.
namespace tactus::view
{

/// Version of the fields, in both forms. Fields are only added with another version.
inline constexpr std::uint16_t kFeedVersion = 1;
/// Maximum number of objects in one datagram.
inline constexpr std::size_t kFeedObjects = 64;

/// Newest state of a controller as one line of JSON, with all its known objects.
[[nodiscard]] std::string feed_json(const LiveController& controller);

/// The fields of one tool and of one object in feed_json().
[[nodiscard]] nlohmann::ordered_json feed_tool(const LiveController& controller,
                                               std::size_t number);
[[nodiscard]] nlohmann::ordered_json feed_object(const ObjectTelemetry& object);

/// The same fields as datagrams of at most 14,464 bytes: packed little-endian records in the order
/// of docs/examples/tactus_feed.h. Each has all tools; the objects are divided among them.
[[nodiscard]] std::vector<std::string> feed_datagrams(const LiveController& controller);

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
