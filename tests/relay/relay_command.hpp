// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace tactus::relay
{

inline constexpr double kDelayMax_ms = 10'000.0;

struct LinkCondition
{
    double delay_ms{0.0}; ///< Delay of every frame, one way, 0 .. kDelayMax_ms.
    /// Additional delay, uniform from 0 to this; frames overtake each other.
    double jitter_ms{0.0};
    double loss{0.0};       ///< Share of the frames that are lost, 0 .. 1.
    double duplicates{0.0}; ///< Share of the arriving frames that are duplicated, 0 .. 1.
};

/// Cut of one or both directions.
struct Cut
{
    bool to_controller{true};
    bool to_server{true};
};
struct Restore
{
};
struct Count
{
};
/// Change of one figure of the condition.
struct Set
{
    double LinkCondition::*figure;
    double value;
};

/// Command to a running relay.
using Command = std::variant<Cut, Restore, Count, Set>;

/// Parses a line: "cut", "cut to-controller", "cut to-server", "restore", "count", or "set" with
/// "delay-ms", "jitter-ms", "loss" or "duplicates" and a number in its range. Empty for any other.
[[nodiscard]] std::optional<Command> parse_command(std::string_view line);

/// Allowed forms, for the refusal of other commands.
[[nodiscard]] std::string command_forms();

} // namespace tactus::relay
