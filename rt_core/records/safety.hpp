// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// State of a tool's force; the words are those of the DHD, a common programming interface of
/// haptic devices.
enum class SafetyState : std::uint8_t
{
    reset, ///< No trustworthy sample yet, or no device: no force.
    idle,  ///< Device known; no force.
    force, ///< The frame's force is sent, or fading in.
    brake  ///< A fault: the last force fades, and the motion is damped.
};
inline constexpr std::size_t kSafetyStates = 4;
static_assert(static_cast<std::size_t>(SafetyState::brake) + 1 == kSafetyStates);

/// Causes for which a force is removed, as a set of bits. The first five are those of the DHD; the
/// others are more specific causes of this library.
enum class ForceOff : std::uint32_t
{
    none = 0,
    velocity = 1U << 0U, ///< The device is faster than the limit.
    /// No force was written for too long: the supervisor or the device cut it off.
    watchdog = 1U << 1U,
    software = 1U << 2U,   ///< The program ends the force: end of the run.
    disconnect = 1U << 3U, ///< The device is disconnected.
    deadman = 1U << 4U,    ///< The user does not hold the device.
    /// The newest sample, or the pose of a touched object, is too old.
    stale = 1U << 5U,
    garbage = 1U << 6U,   ///< A sample or a force is no number or impossible.
    stall = 1U << 7U,     ///< Frames were missed.
    server = 1U << 8U,    ///< A server is lost that may still have to send parts of its model.
    assertion = 1U << 9U, ///< The haptic thread found a bug in itself.
    /// An object was removed or moved too fast while the tool touched an object.
    jump = 1U << 10U,
    halted = 1U << 11U,           ///< The proxy is halted and waits for surface data.
    over_constrained = 1U << 12U, ///< Objects leave the tool no room.
    clutch = 1U << 13U,           ///< A button separates device and tool.
    starved = 1U << 14U,          ///< The proxy waits for data overdue by a second.
    /// The force would change faster than device and objects move.
    growth = 1U << 15U,
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

/// Names of the states, in the order of SafetyState.
inline constexpr std::array<const char*, kSafetyStates> kSafetyStateNames{"reset", "idle", "force",
                                                                          "brake"};
/// Names of the causes, in the order of ForceOff's bits.
inline constexpr std::array<const char*, kForceOffs> kForceOffNames{
    "velocity",         "watchdog", "software", "disconnect", "deadman", "stale",
    "garbage",          "stall",    "server",   "assertion",  "jump",    "halted",
    "over_constrained", "clutch",   "starved",  "growth"};

/// Words about one cause for which a force is withheld.
struct ForceOffWords
{
    const char* why;
    const char* back; ///< Condition for the force to return, after "returns".
};

/// Words in the order of ForceOff's bits (docs/safety.md).
inline constexpr auto kForceOffWords = std::to_array<ForceOffWords>({
    {"the hand is too fast", "when the hand is slower than half the limit"},
    {"the device received no force in time and cut the force off", "when frames are in time again"},
    {"the run ends", "with the next run"},
    {"the device disconnected", "when the device is connected again and has been read"},
    {"no hand holds the device", "when a hand holds the device"},
    {"the device's sample or the pose of a touched object is too old", "with a new sample or pose"},
    {"the device's sample or the force is invalid", "with valid samples"},
    {"frames were missed", "when frames are in time again"},
    {"a server is silent", "when the model is served again"},
    {"the program found an internal fault", "after a restart of the program"},
    {"a touched object was removed or jumped", "at once, from zero"},
    {"the proxy waits for data of the surface", "when the data arrive"},
    {"objects leave the tool no room", "when there is room"},
    {"a button releases the clutch between hand and tool", "when the button is released"},
    {"a piece of the surface, requested a second ago, has not arrived", "when the piece arrives"},
    {"the force would have grown faster than hand and objects moved", "gradually"},
});
static_assert(kForceOffWords.size() == kForceOffs);

} // namespace tactus
