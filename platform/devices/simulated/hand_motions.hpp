// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/simulated/hand_motion.hpp"
#include "platform/devices/simulated/scripted_hand.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/math/vec3.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

namespace tactus
{

/// What a simulated hand does. docs/simulated-device.md describes each.
enum class MotionKind : std::uint8_t
{
    script,   ///< ScriptedHand: flight, approach, slide with lift-offs, retreat.
    free,     ///< Round the model without touching it.
    approach, ///< Down to a landing site, presses and rests there.
    slide,    ///< As the script, but stays on the surface.
    tap,      ///< Two taps a second on one place.
    teleport, ///< Twice a second at once to another place, on the model or round it.
    spin,     ///< Presses and circles on one place, twice a second.
    tremor,   ///< The script with a trembling hand.
    turn,     ///< Presses on one place and turns the tool there about its axes.
    edge,     ///< As slide, and turns the tool with the surface.
    peg,      ///< In and out along z, with tilts, a button and a gripper.
};

/// In the order of MotionKind, for messages.
inline constexpr std::string_view kMotionNames =
    "script, free, approach, slide, tap, teleport, spin, tremor, turn, edge or peg";

/// None when it is no name of a motion.
[[nodiscard]] std::optional<MotionKind> motion_named(std::string_view name);

/// A motion and the workspace that holds all of it.
struct MadeMotion
{
    std::unique_ptr<HandMotion> hand;
    Vec3 centre_world_m{Vec3::Zero()};
    double reach_m{0.0};
};

/// Refuses the scenes that ScriptedHand refuses. The same scene and seed make the same motion, bit
/// for bit; only teleport and tremor look at the seed.
[[nodiscard]] Result<MadeMotion, Refusal> make_motion(MotionKind kind, const HandScene& scene,
                                                      std::uint64_t seed = 1);

} // namespace tactus
