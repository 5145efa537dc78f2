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
    const char* back; ///< Condition of the return, after "comes back".
};

/// Texts in the order of ForceOff's bits (docs/safety.md).
constexpr auto kWords = std::to_array<Words>({
    {"the hand is too fast", "when it is slower than half the limit"},
    {"the device got no force in time and cut it off", "when frames are in time again"},
    {"the run ends", "with the next run"},
    {"the device is gone", "when it is back and has been read"},
    {"nobody holds the device", "when somebody does"},
    {"the device's sample, or the pose of what is touched, is too old", "with a new one"},
    {"the device's sample or the force is no number that can be", "with good samples"},
    {"frames were missed", "when they are in time again"},
    {"a host is silent", "when the model is served again"},
    {"the program found a fault in itself", "when it is started anew"},
    {"a touched object went or jumped", "at once, from zero"},
    {"the proxy waits for data of the surface", "when that has come"},
    {"objects leave the tool no room", "when they do"},
    {"a button parts hand and tool", "when it is released"},
    {"a piece of the surface was asked for a second ago and has not come", "when it has"},
    {"it would have grown faster than hand and objects moved", "step by step"},
});
static_assert(kWords.size() == kForceOffs);

std::string why_of(std::size_t cause, std::span<const ModelTelemetry> models)
{
    std::int64_t silent_ns = 0;
    for (const ModelTelemetry& model : models)
    {
        silent_ns = std::max(silent_ns, model.host_gone ? model.pose_age_ns : 0);
    }
    const bool is_host = 1U << cause == static_cast<std::uint32_t>(ForceOff::host);
    return is_host && silent_ns > 0 ? fmt::format("the host is silent for {:.1f} s",
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
            words += fmt::format("{}{}; comes back {}",
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
        return "off: the device has not been read yet; comes back with its first good sample";
    case SafetyState::brake:
        return "off: a fault has just passed; comes back when the force has faded";
    case SafetyState::idle:
    case SafetyState::force:
        break;
    }
    const char* const inside = "the tool began inside a closed object, which holds it from within";
    return telemetry.in_contact
               ? (tool.begins_inside ? fmt::format("on: {}", inside) : "on")
               : fmt::format("on: no contact, so none is due{}{}", tool.begins_inside ? "; " : "",
                             tool.begins_inside ? inside : "");
}

} // namespace tactus::view
