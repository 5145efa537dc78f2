// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/scene/material_limits.hpp"

#include "platform/loop/tool_port.hpp"
#include "rt_core/force/stiffness_rule.hpp"
#include "transport/material_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tactus::hrtc
{

namespace
{

/// Largest surface damping, in N s/m, with which the device still allows this stiffness. The device
/// must allow it undamped. Rounded down to thousandths.
double largest_damping(const DeviceLimits& device, double period_s, double wall_n_per_m)
{
    double enough = 0.0;
    double too_much = device.damping_n_s_per_m; // The device's whole damping leaves no stiffness.
    while (too_much - enough > 1e-6)
    {
        const double middle = 0.5 * (enough + too_much);
        (stiffness_limit(device, period_s, middle) >= wall_n_per_m ? enough : too_much) = middle;
    }
    return std::floor(1e3 * enough + 1e-2) * 1e-3;
}

std::optional<std::string> wall_refused(const ToolSetup& tool, const std::string& name,
                                        const Material& material)
{
    const DeviceInfo& device = tool.device->info();
    const double period_s = tool.conditioner.period_s;
    const double bare_n_per_m = stiffness_limit(device.limits, period_s);
    const double damping = material.damping_n_s_per_m;
    if (bare_n_per_m < kSoftestFelt_n_per_m ||
        stiffness_limit(device.limits, period_s, damping) >= kSoftestFelt_n_per_m)
    {
        return std::nullopt;
    }
    const double wall_n_per_m =
        std::min({tool.spec.stiffness_n_per_m, material.stiffness_n_per_m, 0.5 * bare_n_per_m});
    return fmt::format(
        "a damping of {:.4g} N s/m on '{}' is too high for the device {} at {:.6g} Hz; at most "
        "{:.3g} N s/m leaves a stiffness that can be felt, at most {:.3g} N s/m one of {:.4g} N/m",
        damping, name, device.name, 1.0 / period_s,
        largest_damping(device.limits, period_s, kSoftestFelt_n_per_m),
        largest_damping(device.limits, period_s, wall_n_per_m), wall_n_per_m);
}

} // namespace

std::optional<std::string> why_unfelt(const std::string& name, const Material& material,
                                      std::span<const ToolSetup> tools)
{
    std::optional<std::string> why;
    for (std::size_t i = 0; i < tools.size() && !why; ++i)
    {
        why = wall_refused(tools[i], name, material);
    }
    return why;
}

/// The tool's stiffness counts, not the material's: the tool may touch a stiffer object at the same
/// time, and the damping limits that wall, too.
Material limited(const Material& material, std::span<const ToolSetup> tools)
{
    Material felt = within_ranges(material);
    for (const ToolSetup& tool : tools)
    {
        const DeviceLimits& device = tool.device->info().limits;
        const double period_s = tool.conditioner.period_s;
        const double wall_n_per_m =
            std::min(tool.spec.stiffness_n_per_m, 0.5 * stiffness_limit(device, period_s));
        if (stiffness_limit(device, period_s, felt.damping_n_s_per_m) < wall_n_per_m)
        {
            felt.damping_n_s_per_m = largest_damping(device, period_s, wall_n_per_m);
        }
    }
    return felt;
}

std::string differences(const Material& from, const Material& to)
{
    std::string text;
    for (const MaterialKey& key : kMaterialKeys)
    {
        if (from.*key.value != to.*key.value)
        {
            text += fmt::format("{}{} {:.4g} to {:.4g}", text.empty() ? "" : ", ", key.name,
                                from.*key.value, to.*key.value);
        }
    }
    return text;
}

} // namespace tactus::hrtc
