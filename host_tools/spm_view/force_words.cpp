// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_view/force_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace tactus::view
{

namespace
{

struct Words
{
    const char* why;
    const char* back; ///< Condition for the force to return, after "comes back".
};

/// Texts in the order of ForceOff's bits (docs/safety.md).
constexpr auto kWords = std::to_array<Words>({
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
static_assert(kWords.size() == kForceOffs);

std::string why_of(std::size_t cause, std::span<const ModelTelemetry> models)
{
    std::int64_t silent_ns = 0;
    for (const ModelTelemetry& model : models)
    {
        silent_ns = std::max(silent_ns, model.server_gone ? model.pose_age_ns : 0);
    }
    const bool is_server = 1U << cause == static_cast<std::uint32_t>(ForceOff::server);
    return is_server && silent_ns > 0 ? fmt::format("the server has been silent for {:.1f} s",
                                                    static_cast<double>(silent_ns) * 1e-9)
                                      : kWords[cause].why;
}

} // namespace

std::string force_words(const RefinementStateTool& tool, const ToolTelemetry& telemetry,
                        std::span<const ModelTelemetry> models)
{
    std::string words;
    for (std::size_t cause = 0; cause < kForceOffs; ++cause)
    {
        if (has_cause(tool.causes, static_cast<ForceOff>(1U << cause)))
        {
            words += fmt::format("{}{}; returns {}",
                                 words.empty() ? "off: " : ". Also: ", why_of(cause, models),
                                 kWords[cause].back);
        }
    }
    if (!words.empty())
    {
        return words;
    }
    switch (tool.state)
    {
    case SafetyState::reset:
        return "off: the device has not been read yet; returns with the first valid sample";
    case SafetyState::brake:
        return "off: a fault has just ended; returns when the force has faded";
    case SafetyState::idle:
    case SafetyState::force:
        break;
    }
    const char* const inside =
        "the tool began inside a closed object, whose surface keeps it inside";
    return telemetry.in_contact
               ? (tool.begins_inside ? fmt::format("on: {}", inside) : "on")
               : fmt::format("on: no contact, so the force is zero{}{}",
                             tool.begins_inside ? "; " : "", tool.begins_inside ? inside : "");
}

} // namespace tactus::view
