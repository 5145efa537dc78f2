// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/run_options.hpp"
#include "platform/choices/tool_choice.hpp"
#include "platform/devices/dhd/dhd_device.hpp"
#include "platform/devices/remote/remote_values.hpp"
#include "platform/loop/burr.hpp"
#include "transport/base/number_form.hpp"
#include "transport/base/printable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bitset>
#include <cstddef>
#include <optional>
#include <utility>

namespace tactus::hrtc
{

namespace
{

/// Sets `value` to the value of `parsed` and returns an empty text, or returns the text of its
/// refusal.
template <typename Value, typename Parsed>
std::string set_to(Value& value, Parsed parsed)
{
    if (!parsed)
    {
        return parsed.error().text;
    }
    value = std::move(parsed).value();
    return {};
}

} // namespace

std::string set_tool_shape(const std::string& text, ToolOptions& tool)
{
    return set_to(tool.shape, parse_tool(text));
}

std::string set_tool_mass(const std::string& text, ToolOptions& tool)
{
    return set_to(tool.load, parse_tool_mass(text));
}

std::string set_tool_fixture(const std::string& text, ToolOptions& tool)
{
    return set_to(tool.fixture, parse_fixture(text));
}

std::string set_tool_device(const std::string& text, ToolOptions& tool)
{
    return set_to(tool.device, parse_device(text));
}

std::string set_tool_limits(const std::string& text, ToolOptions& tool)
{
    const DeviceKind kind = tool.device.kind;
    return kind == DeviceKind::simulated || kind == DeviceKind::dhd
               ? set_device_limits(text, tool.device.limits)
               : fmt::format("'{}': its device tells its own; sim and dhd take some",
                             printable(text));
}

std::string set_tool_frame(const std::string& text, ToolOptions& tool)
{
    std::string fault = set_to(tool.device.frame, parse_placement(text));
    const DeviceKind kind = tool.device.kind;
    return fault.empty() && (kind == DeviceKind::simulated || kind == DeviceKind::replay)
               ? "a simulated or recorded hand is in the world already"
               : fault;
}

std::string set_tool_edit(const std::string& text, ToolOptions& tool)
{
    static constexpr NumberRange kRates[] = {
        {kBurrRateMin_mm3_per_s, kBurrRateMax_mm3_per_s, "mm^3/s"}};
    const auto numbers = read_numbers(text, {"carve:RATE", kRates});
    if (!numbers)
    {
        return numbers.error().text;
    }
    tool.carve_rate_m3_per_s = 1e-9 * numbers.value().front();
    const bool is_hull = tool.shape && !tool.shape->hull_file.empty();
    const bool can_cut =
        !tool.shape || (is_hull ? tool.shape->radius_m == 0.0
                                : burr_shape(tool.shape->core, tool.shape->radius_m).has_value());
    return can_cut ? ""
                   : fmt::format("the tool '{}' can't carve; use a sphere, a capsule, or a box "
                                 "or hull without R",
                                 printable(tool.shape->words));
}

std::string set_tool_motion(const std::string& text, ToolOptions& tool)
{
    const std::size_t colon = std::min(text.find(':'), text.size());
    const std::optional<MotionKind> motion = motion_named(text.substr(0, colon));
    if (!motion || colon + 1 == text.size())
    {
        return fmt::format("'{}' is not {}, perhaps with :OBJECT behind it", printable(text),
                           kMotionNames);
    }
    tool.simulated = {*motion, colon < text.size() ? text.substr(colon + 1) : std::string()};
    return tool.device.kind == DeviceKind::simulated ? "" : "its device is not a simulated one";
}

namespace
{

/// Name of a limit and its member in one of two structs; the other pointer is null.
struct NamedLimit
{
    std::string_view name;
    double DeviceLimits::*value{nullptr};
    double RotationLimits::*turn{nullptr};
};

constexpr std::array kNamedLimits{
    NamedLimit{"mass_kg", &DeviceLimits::mass_kg},
    NamedLimit{"damping_n_s_per_m", &DeviceLimits::damping_n_s_per_m},
    NamedLimit{"friction_n", &DeviceLimits::friction_n},
    NamedLimit{"quantum_m", &DeviceLimits::quantum_m},
    NamedLimit{"delay_s", &DeviceLimits::delay_s},
    NamedLimit{"force_max_n", &DeviceLimits::force_max_n},
    NamedLimit{"slew_max_n_per_s", &DeviceLimits::slew_max_n_per_s},
    NamedLimit{"stiffness_max_n_per_m", &DeviceLimits::stiffness_max_n_per_m},
    NamedLimit{"added_damping_max_n_s_per_m", &DeviceLimits::added_damping_max_n_s_per_m},
    NamedLimit{"rotation.torque_max_nm", nullptr, &RotationLimits::torque_max_nm},
    NamedLimit{"rotation.inertia_kg_m2", nullptr, &RotationLimits::inertia_kg_m2},
    NamedLimit{"rotation.damping_nm_s_per_rad", nullptr, &RotationLimits::damping_nm_s_per_rad},
    NamedLimit{"rotation.friction_nm", nullptr, &RotationLimits::friction_nm},
    NamedLimit{"rotation.quantum_rad", nullptr, &RotationLimits::quantum_rad},
    NamedLimit{"rotation.slew_max_nm_per_s", nullptr, &RotationLimits::slew_max_nm_per_s},
    NamedLimit{"rotation.stiffness_max_nm_per_rad", nullptr,
               &RotationLimits::stiffness_max_nm_per_rad},
    NamedLimit{"rotation.added_damping_max_nm_s_per_rad", nullptr,
               &RotationLimits::added_damping_max_nm_s_per_rad},
};

std::string limit_names()
{
    std::string names;
    for (const NamedLimit& key : kNamedLimits)
    {
        names += (names.empty() ? "" : ", ") + std::string(key.name);
    }
    return names;
}

/// Fault of the limits by the rules for devices that report their own; empty if none.
std::string fault_in_limits(const DeviceLimits& limits)
{
    DeviceInfo info = DhdDeviceOptions::default_info();
    info.name = "device";
    info.limits = limits;
    const char* fault = find_fault(info);
    return fault == nullptr ? "" : fault;
}

} // namespace

std::string set_device_limits(std::string_view text, DeviceLimits& limits)
{
    DeviceLimits changed = limits;
    std::bitset<kNamedLimits.size()> said;
    for (bool is_last = false; !is_last;)
    {
        const std::size_t comma = text.find(',');
        const std::string_view pair = text.substr(0, comma);
        const std::size_t equals = pair.find('=');
        const auto key = std::ranges::find(kNamedLimits, pair.substr(0, equals), &NamedLimit::name);
        if (equals == std::string_view::npos || key == kNamedLimits.end())
        {
            return fmt::format("'{}' is not KEY=VALUE; the keys are {}", printable(pair),
                               limit_names());
        }
        const std::optional<double> value = parse_number(pair.substr(equals + 1));
        if (!value)
        {
            return fmt::format("{}: '{}' is not a number", key->name,
                               printable(pair.substr(equals + 1)));
        }
        const auto at = static_cast<std::size_t>(key - kNamedLimits.begin());
        if (said[at])
        {
            return fmt::format("{} is given twice", key->name);
        }
        said.set(at);
        (key->value != nullptr ? changed.*key->value : changed.rotation.*key->turn) = *value;
        is_last = comma == std::string_view::npos;
        text.remove_prefix(is_last ? text.size() : comma + 1);
    }
    std::string fault = fault_in_limits(changed);
    if (fault.empty())
    {
        limits = changed;
    }
    return fault;
}

} // namespace tactus::hrtc
