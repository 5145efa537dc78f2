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

/// Carries frames between two networks. One thread.
class Relay
{
public:
    /// Both networks must outlive it. The directions have random numbers of their own, made of
    /// `seed`.
    Relay(const TapNetwork& host, const TapNetwork& controller, const LinkCondition& condition,
          std::uint64_t seed);

    /// Takes what both networks have sent and hands over what is due at the clock's time.
    void carry();

    /// When it has to carry again though nobody sends; none when nothing is under way.
    [[nodiscard]] std::optional<MonotonicTime> next_due() const;

    /// Does what the line says; the answer is one line, "done", "refused: " and what is allowed, or
    /// the counts as JSON: of each direction OneWayCounts, `missed`, frames that the system dropped
    /// before they could be read, and `refused_by_system`, those that it didn't take.
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
    Direction to_host_;
    LinkCondition condition_;
    std::vector<std::byte> buffer_;
};

} // namespace tactus::relay
