// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/tool_words.hpp"

#include "platform/choices/device_limits_text.hpp"
#include "platform/loop/burr.hpp"
#include "transport/base/number_form.hpp"
#include "transport/base/printable.hpp"

#include <fmt/format.h>

#include <algorithm>
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

} // namespace tactus::hrtc
