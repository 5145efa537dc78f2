// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/tool_choice.hpp"

#include "host_tools/mesh/read_mesh.hpp"
#include "platform/base/numbers.hpp"
#include "platform/hrtc/messages.hpp"
#include "platform/hrtc/options.hpp"
#include "rt_core/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

namespace tactus::hrtc
{

namespace
{

constexpr double kLengthMin_m = 1e-5;
constexpr double kLengthMax_m = 1.0;
constexpr double kDefaultShare = 0.01;
constexpr double kToolMassMax_kg = 5.0;

bool is_length(double value_m)
{
    return value_m >= kLengthMin_m && value_m <= kLengthMax_m;
}

bool is_radius_round(double value_m)
{
    return value_m == 0.0 || is_length(value_m);
}

bool take_sphere(const std::vector<double>& numbers, ToolChoice& tool)
{
    tool.radius_m = numbers.front();
    return numbers.size() == 1 && is_length(tool.radius_m);
}

bool take_capsule(const std::vector<double>& numbers, ToolChoice& tool)
{
    if (numbers.size() != 2 || !std::ranges::all_of(numbers, is_length))
    {
        return false;
    }
    tool.radius_m = numbers[0];
    const Vec3 end(0.0, 0.0, 0.5 * numbers[1]);
    tool.core = Segment{-end, end};
    return true;
}

bool take_box(const std::vector<double>& numbers, ToolChoice& tool)
{
    if (numbers.size() < 3 || numbers.size() > 4 ||
        !std::all_of(numbers.begin(), numbers.begin() + 3, is_length))
    {
        return false;
    }
    tool.core = Box{0.5 * Vec3(numbers[0], numbers[1], numbers[2])};
    tool.radius_m = numbers.size() == 4 ? numbers[3] : 0.0;
    return is_radius_round(tool.radius_m);
}

/// "NAME[,R]": what stands behind the last comma is part of the name unless it is a number.
bool take_name(std::string_view text, std::string& name, double& radius_m)
{
    const std::size_t comma = text.rfind(',');
    const std::optional<double> radius =
        comma == std::string_view::npos ? std::nullopt : parse_number(text.substr(comma + 1));
    name = radius ? text.substr(0, comma) : text;
    radius_m = radius.value_or(0.0);
    return !name.empty() && is_radius_round(radius_m);
}

std::optional<Refusal> read_hull(ToolChoice& tool)
{
    const auto mesh = read_mesh(tool.hull_file);
    if (!mesh)
    {
        return failure("--tool: " + mesh.error().text);
    }
    std::set<std::tuple<double, double, double>> points; // Files repeat corners.
    for (const auto& p : mesh.value().positions)
    {
        points.emplace(p[0], p[1], p[2]);
    }
    if (points.size() > kMaxHullVertices)
    {
        return failure(fmt::format("--tool: {}: {} corners; the hull of a tool has at most {}",
                                   tool.hull_file, points.size(), kMaxHullVertices));
    }
    std::vector<Vec3> vertices;
    for (const auto& [x, y, z] : points)
    {
        vertices.emplace_back(x, y, z);
        if (vertices.back().norm() > kLengthMax_m)
        {
            return failure(fmt::format("--tool: {}: corner ({:g}, {:g}, {:g}) is {:g} m from the "
                                       "tool's origin; at most {} m",
                                       tool.hull_file, x, y, z, vertices.back().norm(),
                                       kLengthMax_m));
        }
    }
    tool.hull_vertices = std::make_shared<const std::vector<Vec3>>(std::move(vertices));
    tool.core = Hull::create(*tool.hull_vertices).value();
    return std::nullopt;
}

std::optional<Refusal> add_model(ToolChoice& tool, Options& options)
{
    const auto known = std::ranges::find(options.models, tool.mesh_model);
    const auto model = static_cast<std::size_t>(known - options.models.begin());
    if (std::ranges::any_of(options.objects,
                            [model](const PlacedObject& object) { return object.model == model; }))
    {
        return failure(fmt::format("--tool: '{}' is touched as well; a tool needs a model of its "
                                   "own",
                                   tool.mesh_model));
    }
    if (known == options.models.end())
    {
        options.models.push_back(tool.mesh_model);
    }
    tool.core = MeshCore{ModelId{static_cast<std::uint32_t>(model)}};
    return std::nullopt;
}

} // namespace

std::optional<ToolChoice> parse_tool(std::string_view text)
{
    ToolChoice tool;
    tool.words = text;
    if (text == "point")
    {
        return tool;
    }
    const std::size_t colon = text.find(':');
    if (colon == std::string_view::npos)
    {
        return std::nullopt;
    }
    const std::string_view form = text.substr(0, colon);
    const std::string_view rest = text.substr(colon + 1);
    bool is_right = false;
    if (form == "hull")
    {
        is_right = take_name(rest, tool.hull_file, tool.radius_m);
    }
    else if (form == "mesh")
    {
        is_right = take_name(rest, tool.mesh_model, tool.radius_m);
    }
    else if (const auto numbers = parse_numbers(rest))
    {
        is_right = (form == "sphere" && take_sphere(*numbers, tool)) ||
                   (form == "capsule" && take_capsule(*numbers, tool)) ||
                   (form == "box" && take_box(*numbers, tool));
    }
    return is_right ? std::optional(std::move(tool)) : std::nullopt;
}

std::optional<ToolLoad> parse_tool_mass(std::string_view text)
{
    const std::optional<std::vector<double>> numbers = parse_numbers(text);
    if (!numbers || (numbers->size() != 1 && numbers->size() != 4))
    {
        return std::nullopt;
    }
    ToolLoad load;
    load.mass_kg = numbers->front();
    if (numbers->size() == 4)
    {
        load.centre_m = Vec3((*numbers)[1], (*numbers)[2], (*numbers)[3]);
    }
    const bool is_right = load.mass_kg >= 0.0 && load.mass_kg <= kToolMassMax_kg &&
                          load.centre_m.norm() <= kLengthMax_m;
    return is_right ? std::optional(load) : std::nullopt;
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
    for (ToolChoice& tool : options.tool_choices)
    {
        if (auto error = tool.hull_file.empty() ? std::nullopt : read_hull(tool))
        {
            return error;
        }
        if (auto error = tool.mesh_model.empty() ? std::nullopt : add_model(tool, options))
        {
            return error;
        }
    }
    return options.models.size() <= kMaxModels
               ? std::nullopt
               : std::optional(failure(fmt::format("--tool: {} models with those of tools; at most "
                                                   "{}",
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

double hand_radius_m(const ToolChoice& tool, const ModelHeader* mesh, double diagonal_m)
{
    const bool is_round = std::holds_alternative<PointCore>(tool.core);
    const double reach = is_round ? tool.radius_m : 0.5 * reach_m(tool, mesh);
    return reach > 0.0 ? std::min(reach, diagonal_m)
                       : std::min(default_tool(diagonal_m).radius_m, diagonal_m);
}

} // namespace tactus::hrtc
