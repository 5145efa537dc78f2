// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"
#include "tests/relay/one_way.hpp"
#include "tests/relay/relay_command.hpp"
#include "tests/relay/tap_network.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::relay
{

/// Relay of frames between two networks. One thread.
class Relay
{
public:
    /// Connects both networks, which must outlive it. Each direction has its own random numbers
    /// from `seed`.
    Relay(const TapNetwork& server, const TapNetwork& controller, const LinkCondition& condition,
          std::uint64_t seed);

    /// Takes all frames sent by both networks and delivers those due at the clock's time.
    void carry();

    /// Time of the next delivery; empty if no frame is in transit.
    [[nodiscard]] std::optional<MonotonicTime> next_due() const;

    /// Executes a line. The answer is one line: "done", "refused: " with the allowed forms, or the
    /// counts as JSON. These are OneWayCounts of each direction, `missed`, frames that the system
    /// dropped before they could be read, and `refused_by_system`, those that it did not accept.
    [[nodiscard]] std::string answer(std::string_view line);

private:
    struct Direction
    {
        const TapNetwork* from;
        const TapNetwork* to;
        OneWay way;
        std::uint64_t refused_by_system{0};
    };

    void collect(Direction& direction);
    static void deliver(Direction& direction);
    void follow(const Command& command);
    [[nodiscard]] std::string counts() const;

    Direction to_controller_;
    Direction to_server_;
    LinkCondition condition_;
    std::vector<std::byte> buffer_;
};

} // namespace tactus::relay
