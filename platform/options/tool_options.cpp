// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/options/tool_options.hpp"

#include "platform/options/device_limits_text.hpp"
#include "rt_core/limits.hpp"
#include "transport/base/counted.hpp"
#include "transport/base/printable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace tactus::hrtc
{

namespace
{

/// Sets `value` to the result of `parsed`, or else returns the refusal.
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

std::string set_shape(const std::string& text, ToolOptions& tool)
{
    return set_to(tool.shape, parse_tool(text));
}

std::string set_mass(const std::string& text, ToolOptions& tool)
{
    return set_to(tool.load, parse_tool_mass(text));
}

std::string set_fixture(const std::string& text, ToolOptions& tool)
{
    return set_to(tool.fixture, parse_fixture(text));
}

std::string set_device(const std::string& text, ToolOptions& tool)
{
    return set_to(tool.device, parse_device(text));
}

std::string set_limits(const std::string& text, ToolOptions& tool)
{
    const DeviceKind kind = tool.device.kind;
    return kind == DeviceKind::simulated || kind == DeviceKind::dhd
               ? set_device_limits(text, tool.device.limits)
               : fmt::format("'{}': its device tells its own; sim and dhd take some",
                             printable(text));
}

std::string set_frame(const std::string& text, ToolOptions& tool)
{
    std::string fault = set_to(tool.device.frame, parse_placement(text));
    const DeviceKind kind = tool.device.kind;
    return fault.empty() && (kind == DeviceKind::simulated || kind == DeviceKind::replay)
               ? "a simulated or recorded hand is in the world already"
               : fault;
}

std::string set_motion(const std::string& text, ToolOptions& tool)
{
    const std::size_t colon = std::min(text.find(':'), text.size());
    const std::optional<MotionKind> motion = motion_named(text.substr(0, colon));
    if (!motion || colon + 1 == text.size())
    {
        return fmt::format("'{}' is not {}, perhaps with :OBJECT behind it", printable(text),
                           kMotionNames);
    }
    tool.hand = {*motion, colon < text.size() ? text.substr(colon + 1) : std::string()};
    return tool.device.kind == DeviceKind::simulated ? "" : "its device is not a simulated one";
}

constexpr ToolOption kOptions[kToolOptions] = {
    {"shape", "--tool",
     "Tool, in metres: point; sphere:R; capsule:R,L, an axis of length L along z; box:X,Y,Z[,R]; "
     "hull:FILE[,R], of a mesh file's corners; mesh:NAME[@HASH][,R], a model (with --transport "
     "file its path); R is a radius all round [a sphere of 1 % of the first model's diagonal]",
     set_shape},
    {"mass", "--tool-mass",
     "Payload of the device that is to weigh nothing in the hand: KG, 0 to 5 [,X,Y,Z of its "
     "centre in the tool's frame, within 1 m]; down is the device's -z [0]",
     set_mass},
    {"fixture", "--fixture",
     "A spring of its own that guides the tool; world coordinates in m: point:X,Y,Z pulls it "
     "there; line:X,Y,Z,DX,DY,DZ to the line through X,Y,Z along D; plane:X,Y,Z,NX,NY,NZ pushes "
     "it back to the side where N points; gripper:X holds the device's gripper X open, 0 to 1; "
     "each with [,STIFFNESS in N/m, 1 to 3000 [100] [,FORCE at most, in N, 0.01 to 100 [1]]] "
     "[none]",
     set_fixture},
    {"device", "--device",
     "Device that moves the tool: sim[:CLASS], a simulated operator on a device of the class "
     "touch, "
     "omega or delta; udp[:[ADDRESS:]PORT], a driver of your own; dhd[:INDEX], a device of Force "
     "Dimension's; replay:FILE, the hand of a recording; plugin:FILE[,WORDS], a library of your "
     "own [sim]",
     set_device},
    {"device-limits", "--device-limits",
     "Properties of a sim or dhd device, which doesn't tell them: KEY=VALUE with commas between, "
     "as mass_kg=0.2,damping_n_s_per_m=1.5; stability depends on them, so measure them [as the "
     "class; of dhd what is safe for most]",
     set_limits},
    {"device-frame", "--device-frame",
     "Where the device's coordinates are in the world: as --place, SCALE being that of its motion "
     "[the world's]",
     set_frame},
    {"motion", "--motion",
     "Motion of a simulated operator: script, free, approach, slide, tap, teleport, spin, tremor, "
     "turn, edge or peg; with :OBJECT behind it, on the scene's object of this name, or the first "
     "that shows the model of this name [script, each hand on another object]",
     set_motion},
};

/// Text of an option of one tool, and its source.
struct Said
{
    std::string text;
    std::string place; ///< FILE:LINE; empty: the command line.
};

/// Given text of an option; none if the tool has the default.
std::optional<Said> said_of(const RawOptions& raw, std::size_t tool, std::size_t option)
{
    std::optional<Said> said;
    if (tool < raw.of_tools[option].size())
    {
        said = {raw.of_tools[option][tool], ""};
    }
    else if (tool < raw.tool_tables.size())
    {
        const OptionTable& table = raw.tool_tables[tool];
        const auto entry = std::ranges::find(table, kOptions[option].key, &TableEntry::key);
        said =
            entry != table.end() ? std::optional<Said>({entry->value, entry->place}) : std::nullopt;
    }
    return said && said->text == "none" ? std::nullopt : said;
}

/// Number of tools with a given option. If it exceeds `most`, sets `fault`.
std::size_t count_tools(const RawOptions& raw, std::size_t most, std::string& fault)
{
    std::size_t count = 0;
    const auto take = [&](std::size_t given, const char* name)
    {
        count = std::max(count, given);
        if (given > most && fault.empty())
        {
            fault = fmt::format("{}: {} given; at most {}", name, given, counted(most, "tool"));
        }
    };
    for (std::size_t option = 0; option < kToolOptions; ++option)
    {
        take(raw.of_tools[option].size(), kOptions[option].option);
    }
    take(raw.tool_tables.size(), "[[tool]]");
    return count;
}

/// Text quoted for TOML.
std::string quoted(const std::string& text)
{
    const char quote = text.find('"') == std::string::npos ? '"' : '\'';
    return quote + text + quote;
}

} // namespace

std::span<const ToolOption, kToolOptions> tool_options()
{
    return kOptions;
}

std::string take_tools(Options& options, const RawOptions& raw)
{
    std::string fault;
    const std::size_t said = count_tools(raw, raw.tool_count.value_or(kMaxTools), fault);
    options.tools.resize(raw.tool_count.value_or(std::max<std::size_t>(said, 1)));
    for (std::size_t tool = 0; tool < options.tools.size() && fault.empty(); ++tool)
    {
        for (std::size_t i = 0; i < kToolOptions && fault.empty(); ++i)
        {
            const std::optional<Said> one = said_of(raw, tool, i);
            fault = one ? kOptions[i].set(one->text, options.tools[tool]) : "";
            if (!fault.empty())
            {
                fault = (one->place.empty() ? options.of_tool(kOptions[i].option, tool)
                                            : fmt::format("{}: {} of tool {}", one->place,
                                                          kOptions[i].key, tool)) +
                        ": " + fault;
            }
        }
    }
    return fault;
}

std::string tool_tables(const RawOptions& raw)
{
    std::string fault;
    const std::size_t count = count_tools(raw, kMaxTools, fault);
    std::string text;
    for (std::size_t tool = 0; tool < count; ++tool)
    {
        text += "\n[[tool]]\n";
        for (std::size_t i = 0; i < kToolOptions; ++i)
        {
            const std::optional<Said> said = said_of(raw, tool, i);
            text += said ? fmt::format("{}={}\n", kOptions[i].key, quoted(said->text)) : "";
        }
    }
    return text;
}

} // namespace tactus::hrtc
