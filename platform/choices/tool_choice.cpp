// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/tool_choice.hpp"

#include "platform/choices/messages.hpp"
#include "platform/choices/run_options.hpp"
#include "rt_core/limits.hpp"
#include "transport/base/number_form.hpp"
#include "transport/base/printable.hpp"
#include "transport/base/suggestions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>
#include <variant>

namespace tactus::hrtc
{

namespace
{

constexpr double kLengthMin_m = 1e-5;
constexpr double kLengthMax_m = 1.0;
constexpr double kDefaultShare = 0.01;

constexpr NumberRange kLengthRange{kLengthMin_m, kLengthMax_m, "m"};
constexpr NumberRange kRoundRange{kLengthMin_m, kLengthMax_m, "m", true};
constexpr NumberRange kOfSphere[] = {kLengthRange};
constexpr NumberRange kOfCapsule[] = {kLengthRange, kLengthRange};
constexpr NumberRange kOfBox[] = {kLengthRange, kLengthRange, kLengthRange, kRoundRange};
constexpr NumberForm kSphereForm{"sphere:R", kOfSphere};
constexpr NumberForm kCapsuleForm{"capsule:R,L", kOfCapsule};
constexpr NumberForm kBoxForm{"box:X,Y,Z[,R]", kOfBox};
constexpr std::string_view kHullForm = "hull:FILE[,R]";
constexpr std::string_view kMeshForm = "mesh:NAME[,R]";

constexpr NumberRange kCentreRange{-kLengthMax_m, kLengthMax_m, "m"};
constexpr NumberRange kOfMass[] = {{0.0, 5.0, "kg"}, kCentreRange, kCentreRange, kCentreRange};
constexpr NumberForm kMassForm{"KG[,X,Y,Z]", kOfMass};

/// Parses the rest of "hull:NAME[,R]" or "mesh:NAME[,R]". Text after the last comma belongs to the
/// name unless it is a number.
std::optional<Refusal> take_name(std::string_view text, std::string_view form, std::string& name,
                                 double& radius_m)
{
    const std::string_view rest = text.substr(std::min(text.find(':'), text.size() - 1) + 1);
    const std::size_t comma = rest.rfind(',');
    const std::optional<double> radius =
        comma == std::string_view::npos ? std::nullopt : parse_number(rest.substr(comma + 1));
    name = radius ? rest.substr(0, comma) : rest;
    radius_m = radius.value_or(0.0);
    const std::string fault = name.empty() ? "the name is missing"
                              : radius ? fault_of_number("R", rest.substr(comma + 1), kRoundRange)
                                       : "";
    return fault.empty() ? std::nullopt : std::optional(not_of_form(text, form, fault));
}

/// Synonyms of tool words, each with the word that a refusal proposes.
constexpr std::pair<std::string_view, std::string_view> kOtherWords[] = {
    {"ball", "sphere"}, {"cube", "box"}, {"cuboid", "box"}, {"cylinder", "capsule"}};

/// Refusal of a text that begins with no tool word.
Refusal no_tool(std::string_view text)
{
    constexpr std::string_view kWords[] = {"point", "sphere", "capsule", "box", "hull", "mesh"};
    const std::string_view word = text.substr(0, text.find(':'));
    const auto* other =
        std::ranges::find(kOtherWords, word, &std::pair<std::string_view, std::string_view>::first);
    const std::string nearest =
        other != std::end(kOtherWords) ? std::string(other->second) : nearest_word(word, kWords);
    const std::string meant = nearest + std::string(text.substr(word.size()));
    return {nearest.empty() || nearest == word || !parse_tool(meant)
                ? fmt::format("'{}' is not point, {}, {}, {}, {} or {}", printable(text),
                              kSphereForm.text, kCapsuleForm.text, kBoxForm.text, kHullForm,
                              kMeshForm)
                : fmt::format("'{}': no tool is called '{}'; {}?", printable(text), printable(word),
                              printable(meant))};
}

/// Reads the hull's file and sets the core. `option`: the option's name for a refusal.
std::optional<Refusal> read_hull(ToolChoice& tool, const FileReaders& readers,
                                 const std::string& option)
{
    const auto corners = readers.read_corners(tool.hull_file);
    if (!corners)
    {
        return failure(fmt::format("{}: {}", option, corners.error().text));
    }
    return set_hull(tool, corners.value(), fmt::format("{}: {}", option, tool.hull_file));
}

std::optional<Refusal> add_model(ToolChoice& tool, Options& options, const std::string& option)
{
    const auto known = std::ranges::find(options.models, tool.mesh_model);
    const auto model = static_cast<std::size_t>(known - options.models.begin());
    if (std::ranges::any_of(options.objects,
                            [model](const PlacedObject& object) { return object.model == model; }))
    {
        return failure(
            fmt::format("{}: '{}' is the model of an object as well; a tool needs its own model",
                        option, tool.mesh_model));
    }
    if (known == options.models.end())
    {
        options.models.push_back(tool.mesh_model);
    }
    tool.core = MeshCore{ModelId{static_cast<std::uint32_t>(model)}};
    return std::nullopt;
}

} // namespace

Result<ToolChoice, Refusal> parse_tool(std::string_view text)
{
    ToolChoice tool;
    tool.words = text;
    const std::string_view word = text.substr(0, text.find(':'));
    if (text == "point")
    {
        return tool;
    }
    if (word == "hull" || word == "mesh")
    {
        const bool is_hull = word == "hull";
        const auto refusal = take_name(text, is_hull ? kHullForm : kMeshForm,
                                       is_hull ? tool.hull_file : tool.mesh_model, tool.radius_m);
        return refusal ? Result<ToolChoice, Refusal>(*refusal) : std::move(tool);
    }
    const NumberForm* const form = word == "sphere"    ? &kSphereForm
                                   : word == "capsule" ? &kCapsuleForm
                                   : word == "box"     ? &kBoxForm
                                                       : nullptr;
    if (form == nullptr)
    {
        return no_tool(text);
    }
    const auto numbers = read_numbers(text, *form);
    if (!numbers)
    {
        return numbers.error();
    }
    const std::vector<double>& n = numbers.value();
    if (form == &kBoxForm)
    {
        tool.core = Box{0.5 * Vec3(n[0], n[1], n[2])};
        tool.radius_m = n.size() == 4 ? n[3] : 0.0;
        return tool;
    }
    tool.radius_m = n[0];
    if (form == &kCapsuleForm)
    {
        const Vec3 end(0.0, 0.0, 0.5 * n[1]);
        tool.core = Segment{-end, end};
    }
    return tool;
}

Result<ToolLoad, Refusal> parse_tool_mass(std::string_view text)
{
    const auto numbers = read_numbers(text, kMassForm);
    if (!numbers)
    {
        return numbers.error();
    }
    const std::vector<double>& n = numbers.value();
    ToolLoad load;
    load.mass_kg = n[0];
    if (n.size() == 4)
    {
        load.centre_m = Vec3(n[1], n[2], n[3]);
    }
    if (load.centre_m.norm() > kLengthMax_m)
    {
        return not_of_form(text, kMassForm.text, "X,Y,Z is more than 1 m away");
    }
    return load;
}

std::optional<Refusal> set_hull(ToolChoice& tool, std::span<const Vec3> corners,
                                const std::string& source)
{
    // Files repeat corners; a set keeps each once.
    std::set<std::tuple<double, double, double>> points;
    for (const Vec3& p : corners)
    {
        points.emplace(p[0], p[1], p[2]);
    }
    if (points.size() > kMaxHullVertices)
    {
        return failure(fmt::format("{}: {} corners; the hull of a tool has at most {}", source,
                                   points.size(), kMaxHullVertices));
    }
    std::vector<Vec3> vertices;
    for (const auto& [x, y, z] : points)
    {
        vertices.emplace_back(x, y, z);
        if (vertices.back().norm() > kLengthMax_m)
        {
            return failure(fmt::format("{}: corner ({:g}, {:g}, {:g}) is {:g} m from the tool's "
                                       "origin; at most {} m",
                                       source, x, y, z, vertices.back().norm(), kLengthMax_m));
        }
    }
    tool.hull_vertices = std::make_shared<const std::vector<Vec3>>(std::move(vertices));
    tool.core = Hull::create(*tool.hull_vertices).value();
    return std::nullopt;
}

bool is_round(const ToolOptions& tool)
{
    return !tool.shape || (std::holds_alternative<PointCore>(tool.shape->core) &&
                           tool.shape->hull_file.empty() && tool.shape->mesh_model.empty());
}

ToolChoice default_tool(double diagonal_m)
{
    ToolChoice tool;
    tool.radius_m = std::clamp(kDefaultShare * diagonal_m, kLengthMin_m, kLengthMax_m);
    tool.words = fmt::format("sphere:{:g}", tool.radius_m);
    return tool;
}

std::optional<Refusal> take_tool_files(Options& options)
{
    for (std::size_t i = 0; i < options.tools.size(); ++i)
    {
        std::optional<ToolChoice>& tool = options.tools[i].shape;
        const std::string option = options.of_tool("--tool", i);
        if (auto error = tool && !tool->hull_file.empty()
                             ? read_hull(*tool, options.readers, option)
                             : std::nullopt)
        {
            return error;
        }
        if (auto error = tool && !tool->mesh_model.empty() ? add_model(*tool, options, option)
                                                           : std::nullopt)
        {
            return error;
        }
    }
    return options.models.size() <= kMaxModels
               ? std::nullopt
               : std::optional(
                     failure(fmt::format("--tool: {} models, including those of tools; at most {}",
                                         options.models.size(), kMaxModels)));
}

double reach_m(const ToolChoice& tool, const ModelHeader* mesh)
{
    double core_m = 0.0;
    if (const auto* segment = std::get_if<Segment>(&tool.core))
    {
        core_m = segment->to.norm();
    }
    else if (const auto* box = std::get_if<Box>(&tool.core))
    {
        core_m = box->half.norm();
    }
    else if (tool.hull_vertices != nullptr)
    {
        for (const Vec3& vertex : *tool.hull_vertices)
        {
            core_m = std::max(core_m, vertex.norm());
        }
    }
    else if (mesh != nullptr)
    {
        core_m = mesh->origin_m().norm() + mesh->diagonal_m();
    }
    return core_m + tool.radius_m;
}

double operator_radius_m(const ToolChoice& tool, const ModelHeader* mesh, double diagonal_m)
{
    const bool is_round = std::holds_alternative<PointCore>(tool.core);
    const double reach = is_round ? tool.radius_m : 0.5 * reach_m(tool, mesh);
    return reach > 0.0 ? std::min(reach, diagonal_m)
                       : std::min(default_tool(diagonal_m).radius_m, diagonal_m);
}

} // namespace tactus::hrtc
