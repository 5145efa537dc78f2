// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/tool_choice.hpp"
#include "platform/options/option_table.hpp"
#include "rt_core/limits.hpp"
#include "transport/base/number_form.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace tactus::hrtc
{

namespace
{

constexpr ToolOption kOptions[kToolOptions] = {
    {"shape", "--tool",
     "Shape of the tool, in metres: point; sphere:R; capsule:R,L, an axis of length L along z; "
     "box:X,Y,Z[,R]; hull:FILE[,R], the convex hull of a mesh file's vertices; "
     "mesh:NAME[@HASH][,R], a model (with --transport file, its path). R is a radius added all "
     "round [default: a sphere with a radius of 1 % of the first model's diagonal]",
     set_tool_shape},
    {"mass", "--tool-mass",
     "Payload of the device for gravity compensation: KG, 0 to 5 [,X,Y,Z of the payload's centre "
     "in the tool's frame, in m, within 1 m]. Down is -z of the device [default: 0]",
     set_tool_mass},
    {"fixture", "--fixture",
     "Virtual fixture, a spring that guides the tool, in world coordinates and m: point:X,Y,Z "
     "pulls the tool to the point; line:X,Y,Z,DX,DY,DZ pulls the tool to the line through X,Y,Z "
     "along D; plane:X,Y,Z,NX,NY,NZ pushes the tool back to the side to which N points; gripper:X "
     "holds the device's gripper open by X, 0 to 1. Each form takes [,STIFFNESS in N/m, 1 to 3000 "
     "[,maximum FORCE in N, 0.01 to 100]], otherwise 100 N/m and 1 N [default: none]",
     set_tool_fixture},
    {"edit", "--edit",
     "Change of published models by the tool: carve:RATE removes material where the tool presses. "
     "The volume in a second is 1000 mm^3 x force in N x speed in m/s, at most RATE in mm^3/s, "
     "0.01 to 10000. The speed is that of the tool over the surface plus 0.05 m/s for its own "
     "rotation. The models' server must permit it (spm_publish --edits) [default: none]",
     set_tool_edit},
    {"device", "--device",
     "Device that moves the tool: sim[:CLASS], a simulated operator on a device of the class "
     "touch, omega or delta; udp[:[ADDRESS:]PORT], a driver of your own; dhd[:INDEX], a device of "
     "Force Dimension; replay:FILE, the device of a recording; plugin:FILE[,WORDS], a library of "
     "your own by its full path [default: sim]",
     set_tool_device},
    {"device-limits", "--device-limits",
     "Properties of a sim or dhd device, which does not report them: KEY=VALUE with commas "
     "between, such as mass_kg=0.2,damping_n_s_per_m=1.5. Stability depends on these properties; "
     "measure them [default: those of the class; for dhd, values that are safe for most devices]",
     set_tool_limits},
    {"device-frame", "--device-frame",
     "Pose in the world of the coordinates of a udp, dhd or plugin device, in the form of --place; "
     "SCALE is the scale of the device's motion [default: world coordinates]",
     set_tool_frame},
    {"motion", "--motion",
     "Motion of a simulated operator: script, free, approach, slide, tap, teleport, spin, tremor, "
     "turn, edge or peg. With :OBJECT behind the motion, the operator touches the scene's object "
     "with this name, or the first object that shows the model with this name [default: script, "
     "each operator on another object]",
     set_tool_motion},
};

/// Text given for an option of one tool, and where.
struct Said
{
    std::string text;
    std::string place; ///< Place as FILE:LINE; empty: the command line.
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

/// Number of tools that the options and tables give values for. If one gives more than `most`, sets
/// `fault`.
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

std::string set_tools(Options& options, const RawOptions& raw)
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
