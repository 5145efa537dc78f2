// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/relay/relay.hpp"

#include "platform/machine/posix/posix_clock.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <span>
#include <variant>

namespace tactus::relay
{

namespace
{

using Json = nlohmann::ordered_json;

/// Size for the largest MTU of main.cpp with headers of all kinds.
constexpr std::size_t kFrameBytesMax = std::size_t{16} << 10U;
/// Frames taken from one network before the other's turn and the delivery of due ones.
constexpr int kFramesInTurn = 64;

Json json_of(const OneWayCounts& counts, std::uint64_t missed, std::uint64_t refused_by_system)
{
    return {{"frames", counts.frames},
            {"bytes", counts.bytes},
            {"udp_datagrams", counts.udp_datagrams},
            {"udp_payload_bytes", counts.udp_payload_bytes},
            {"delivered", counts.delivered},
            {"lost", counts.lost},
            {"duplicated", counts.duplicated},
            {"cut", counts.cut},
            {"dropped_full", counts.dropped_full},
            {"missed", missed},
            {"refused_by_system", refused_by_system}};
}

MonotonicTime now()
{
    return PosixClock().now();
}

} // namespace

Relay::Relay(const TapNetwork& server, const TapNetwork& controller, const LinkCondition& condition,
             std::uint64_t seed)
    : to_controller_{&server, &controller, OneWay(2 * seed)}
    , to_server_{&controller, &server, OneWay(2 * seed + 1)}
    , condition_(condition)
    , buffer_(kFrameBytesMax)
{
}

void Relay::carry()
{
    collect(to_controller_);
    collect(to_server_);
    deliver(to_controller_);
    deliver(to_server_);
}

void Relay::collect(Direction& direction)
{
    for (int i = 0; i < kFramesInTurn; ++i)
    {
        const std::size_t bytes = direction.from->read(buffer_);
        if (bytes == 0)
        {
            return;
        }
        direction.way.take(std::span(buffer_).first(bytes), condition_, now());
    }
}

void Relay::deliver(Direction& direction)
{
    const MonotonicTime until = now();
    while (const auto frame = direction.way.take_due(until))
    {
        direction.refused_by_system += direction.to->write(*frame) ? 0U : 1U;
    }
}

std::optional<MonotonicTime> Relay::next_due() const
{
    const std::optional<MonotonicTime> one = to_controller_.way.next_due();
    const std::optional<MonotonicTime> other = to_server_.way.next_due();
    return one && other ? std::min(one, other) : (one ? one : other);
}

std::string Relay::answer(std::string_view line)
{
    const std::optional<Command> command = parse_command(line);
    if (!command)
    {
        return "refused: allowed are " + command_forms();
    }
    if (std::holds_alternative<Count>(*command))
    {
        return counts();
    }
    follow(*command);
    return "done";
}

void Relay::follow(const Command& command)
{
    if (const auto* set = std::get_if<Set>(&command))
    {
        condition_.*set->figure = set->value;
        return;
    }
    if (const auto* cut = std::get_if<Cut>(&command))
    {
        if (cut->to_controller)
        {
            to_controller_.way.cut();
        }
        if (cut->to_server)
        {
            to_server_.way.cut();
        }
        return;
    }
    to_controller_.way.restore();
    to_server_.way.restore();
}

std::string Relay::counts() const
{
    const auto side = [](const Direction& direction)
    {
        return json_of(direction.way.counts(), direction.from->frames_missed(),
                       direction.refused_by_system);
    };
    return Json{{"to_controller", side(to_controller_)}, {"to_server", side(to_server_)}}.dump();
}

} // namespace tactus::relay
