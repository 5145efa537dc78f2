// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace tactus
{

/// Motions of a simulated operator. docs/simulated-device.md describes each.
enum class MotionKind : std::uint8_t
{
    script,   ///< ScriptedOperator: flight, approach, slide with lift-offs, retreat.
    free,     ///< Moves around the model without contact.
    approach, ///< Descends to a landing site, presses and rests there.
    slide,    ///< The script without lift-offs.
    tap,      ///< Two taps a second at one place.
    teleport, ///< Jumps twice a second to another place, on the model or around it.
    spin,     ///< Presses and circles at one place, twice a second.
    tremor,   ///< The script with tremor.
    turn,     ///< Presses at one place and rotates the tool about its axes.
    edge,     ///< Slides and rotates the tool with the surface.
    peg,      ///< Moves in and out along z, with tilts, a button and a gripper.
};

/// Names in the order of MotionKind, for messages.
inline constexpr std::string_view kMotionNames =
    "script, free, approach, slide, tap, teleport, spin, tremor, turn, edge or peg";

/// Motion of this name; none for other names.
[[nodiscard]] std::optional<MotionKind> motion_named(std::string_view name);

} // namespace tactus
