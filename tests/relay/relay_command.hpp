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

/// What a link does to the frames of each direction.
struct LinkCondition
{
    double delay_ms{0.0};   ///< Of every frame, one way, 0 .. kDelayMax_ms.
    double jitter_ms{0.0};  ///< On top of it, uniform from 0 to this; frames overtake each other.
    double loss{0.0};       ///< Share of the frames that don't arrive, 0 .. 1.
    double duplicates{0.0}; ///< Share of those that do and arrive twice, 0 .. 1.
};

struct Cut
{
};
struct Mend
{
};
struct Count
{
};
/// One figure of the condition becomes another.
struct Set
{
    double LinkCondition::*figure;
    double value;
};

/// What the relay is told while it runs.
using Command = std::variant<Cut, Mend, Count, Set>;

/// Reads a line: "cut", "mend", "count", or "set" with "delay-ms", "jitter-ms", "loss" or
/// "duplicates" and a number in its range. None when it is another.
[[nodiscard]] std::optional<Command> parse_command(std::string_view line);

/// What is allowed, for whoever said something else.
[[nodiscard]] std::string command_forms();

} // namespace tactus::relay
