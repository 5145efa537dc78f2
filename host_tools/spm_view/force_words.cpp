// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_view/state_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

namespace tactus::view
{

namespace
{

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
                                      : kForceOffWords[cause].why;
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
                                 kForceOffWords[cause].back);
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
