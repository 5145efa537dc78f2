// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// What a tool's force is doing; the words of the DHD, a common programming interface of haptic
/// devices.
enum class SafetyState : std::uint8_t
{
    reset, ///< No trustworthy sample yet, or the device is gone: no force.
    idle,  ///< The device is known; no force.
    force, ///< The frame's force goes out, or is on its way there.
    brake  ///< Something is wrong: the last force fades, the motion is damped.
};
inline constexpr std::size_t kSafetyStates = 4;
static_assert(static_cast<std::size_t>(SafetyState::brake) + 1 == kSafetyStates);

/// Why a force is taken away, a set. The first five are the DHD's; the others say more exactly
/// what a watch of ours has found.
enum class ForceOff : std::uint32_t
{
    none = 0,
    velocity = 1U << 0U,   ///< The hand is faster than the limit.
    watchdog = 1U << 1U,   ///< Nobody wrote a force for too long: supervisor or device cut it off.
    software = 1U << 2U,   ///< The program wants no force: the run ends.
    disconnect = 1U << 3U, ///< The device is gone.
    deadman = 1U << 4U,    ///< Nobody holds the device.
    stale = 1U << 5U,      ///< The newest sample, or the pose of what is touched, is too old.
    garbage = 1U << 6U,    ///< A sample or a force is no number or can't be.
    stall = 1U << 7U,      ///< Frames were missed.
    host = 1U << 8U,       ///< A host is lost that may still have to send parts of its model.
    assertion = 1U << 9U,  ///< The haptic thread found a bug in itself.
    jump = 1U << 10U,      ///< An object went, or moved too fast, while the tool touched one.
    frozen = 1U << 11U,    ///< The proxy waits for data of the surface.
    squeezed = 1U << 12U,  ///< Objects leave the tool no room.
    clutch = 1U << 13U,    ///< A button has parted hand and tool.
    starved = 1U << 14U,   ///< The proxy waits for a piece that hasn't come for a second.
    growth = 1U << 15U,    ///< It wants to change faster than hand and objects move.
};
inline constexpr std::size_t kForceOffs = 16;
static_assert(static_cast<std::uint32_t>(ForceOff::growth) == 1U << (kForceOffs - 1));

[[nodiscard]] constexpr ForceOff operator|(ForceOff a, ForceOff b) noexcept
{
    return static_cast<ForceOff>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
constexpr ForceOff& operator|=(ForceOff& a, ForceOff b) noexcept
{
    return a = a | b;
}
[[nodiscard]] constexpr ForceOff operator&(ForceOff a, ForceOff b) noexcept
{
    return static_cast<ForceOff>(static_cast<std::uint32_t>(a) & static_cast<std::uint32_t>(b));
}
[[nodiscard]] constexpr bool has_cause(ForceOff set, ForceOff one) noexcept
{
    return (static_cast<std::uint32_t>(set) & static_cast<std::uint32_t>(one)) != 0;
}

/// In the order of SafetyState.
inline constexpr std::array<const char*, kSafetyStates> kSafetyStateNames{"reset", "idle", "force",
                                                                          "brake"};
/// In the order of ForceOff's bits.
inline constexpr std::array<const char*, kForceOffs> kForceOffNames{
    "velocity", "watchdog",  "software", "disconnect", "deadman",  "stale",  "garbage", "stall",
    "host",     "assertion", "jump",     "frozen",     "squeezed", "clutch", "starved", "growth"};

} // namespace tactus
