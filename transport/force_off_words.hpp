// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/safety.hpp"

#include <array>

// Any thread: constants.
namespace tactus
{

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
