// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/world/world_values.hpp"

#include "platform/choices/messages.hpp"
#include "platform/choices/run_options.hpp"
#include "platform/loop/burr.hpp"
#include "platform/scene/scene_parts.hpp"
#include "rt_core/math/rotation.hpp"
#include "transport/base/number_form.hpp"
#include "transport/material_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

namespace tactus
{

namespace
{

Material material_of(const MaterialOptions& options)
{
    Material material;
    material.stiffness_n_per_m = options.stiffness_n_per_m.value_or(Material{}.stiffness_n_per_m);
    material.static_friction = options.static_friction;
    material.dynamic_friction = options.dynamic_friction.value_or(options.static_friction);
    material.damping_n_s_per_m = options.damping_n_s_per_m;
    material.viscosity_n_s_per_m = options.viscosity_n_s_per_m;
    material.texture_height_m = options.texture_height_m;
    material.texture_length_m = options.texture_length_m;
    return material;
}

} // namespace

Refusal wrong_value(std::string text)
{
    return {std::move(text), true};
}

Result<Material, Refusal> checked_material(const MaterialOptions& options)
{
    const Material material = material_of(options);
    return is_in_range(material) ? Result<Material, Refusal>(material)
                                 : wrong_value(fmt::format("material: out of range; allowed are {}",
                                                           kMaterialRanges));
}

Result<Similarity, Refusal> checked_place(const Pose& pose)
{
    const auto checked = checked_pose(pose);
    if (!checked)
    {
        return wrong_value(fmt::format(
            "pose: {} is out of range; allowed are a unit quaternion, a translation within {} m "
            "and a scale of {} to {}",
            kPoseRefusalNames[static_cast<std::size_t>(checked.error())], kPoseReachMax_m,
            kPoseScaleMin, kPoseScaleMax));
    }
    return hrtc::to_similarity(checked.value());
}

std::optional<Refusal> fault_of(const HandPose& pose)
{
    const bool is_near = std::ranges::all_of(pose.position_m, [](double x)
                                             { return std::abs(x) < kGoalRange_m; }); // NaN fails.
    if (!is_near)
    {
        return wrong_value(fmt::format("position_m: ({}, {}, {}); each must be within {} m",
                                       pose.position_m[0], pose.position_m[1], pose.position_m[2],
                                       kGoalRange_m));
    }
    return is_unit(pose.rotation, kRotationTolerance)
               ? std::nullopt
               : std::optional(
                     wrong_value(fmt::format("rotation: ({}, {}, {}, {}) is no quaternion of "
                                             "length 1 within {}",
                                             pose.rotation[0], pose.rotation[1], pose.rotation[2],
                                             pose.rotation[3], kRotationTolerance)));
}

Result<hrtc::ToolChoice, Refusal> checked_shape(const WorldTool& tool)
{
    if (!tool.words.empty())
    {
        hrtc::ToolOptions made;
        const std::string fault = hrtc::set_tool_shape(tool.words, made);
        return fault.empty() ? Result<hrtc::ToolChoice, Refusal>(*std::move(made.shape))
                             : hrtc::failure("tool: " + fault);
    }
    hrtc::ToolChoice shape;
    shape.radius_m = tool.radius_m;
    if (!(tool.radius_m >= 0.0 && tool.radius_m <= 1.0))
    {
        return hrtc::failure(fmt::format("tool: radius {} m; 0 to 1 is allowed", tool.radius_m));
    }
    if (tool.model)
    {
        return shape;
    }
    std::vector<Vec3> corners;
    for (const auto& [x, y, z] : tool.corners)
    {
        corners.emplace_back(x, y, z);
    }
    if (corners.empty() ||
        !std::ranges::all_of(corners, [](const Vec3& corner) { return corner.allFinite(); }))
    {
        return hrtc::failure("tool: a hull needs corners, all of them finite");
    }
    shape.words = fmt::format("hull of {}", counted(corners.size(), "corner"));
    const auto refusal = hrtc::set_hull(shape, corners, "tool");
    return refusal ? Result<hrtc::ToolChoice, Refusal>(*refusal) : shape;
}

Result<Sweep, Refusal> checked_sweep(const WorldTool& shape, const HandPose& from,
                                     const std::array<double, 3>& to_m)
{
    const auto tool = checked_shape(shape);
    if (!tool)
    {
        return tool.error();
    }
    const hrtc::ToolChoice& made = tool.value();
    const bool has_file = shape.model || !made.hull_file.empty() || !made.mesh_model.empty();
    const auto burr = has_file ? std::nullopt : hrtc::burr_shape(made.core, made.radius_m);
    if (!burr)
    {
        return hrtc::failure("tool: only a sphere, a capsule, and a box or hull of given corners "
                             "without a radius can edit");
    }
    if (auto fault = fault_of(from))
    {
        return *std::move(fault);
    }
    const auto& [x, y, z, w] = from.rotation;
    return Sweep{burr->core_m, burr->radius_m,
                 Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix(),
                 Vec3(from.position_m[0], from.position_m[1], from.position_m[2]),
                 Vec3(to_m[0], to_m[1], to_m[2])};
}

} // namespace tactus

namespace tactus::hrtc
{

namespace
{

/// Options whose names differ in more than dashes. A name stands before those that it begins with.
constexpr std::pair<std::string_view, std::string_view> kNames[] = {
    {"--pool-mib", "memory_mib"},
    {"--memory-mib", "the machine"},
    {"--rate", "rate_hz"},
    {"--stiffness", "stiffness_n_per_m"},
    {"--angular-stiffness", "angular_stiffness_nm_per_rad"},
    {"--force-shading", "shading_m"},
    {"--force-tolerance", "force_tolerance_n"},
    {"--objects", "objects_max"},
    {"--tool-mass", "payload"},
    {"--place", "pose"},
    {"--edits", "--edits"}, // The option of a server.
};

/// Characters before an option of a message; dashes behind others are those of a file's name.
constexpr std::string_view kBefore = " '(";

bool is_of_name(char c)
{
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-';
}

/// Name of a World's option or part for an option of hrtc, without the leading dashes if no other
/// name is known.
std::string name_of(std::string_view option)
{
    for (const auto& [of_hrtc, of_world] : kNames)
    {
        if (option == of_hrtc)
        {
            return std::string(of_world);
        }
    }
    std::string name(option.substr(2));
    for (char& c : name)
    {
        c = c == '-' ? '_' : c;
    }
    return name;
}

} // namespace

std::string world_words(std::string text)
{
    std::string said;
    for (std::size_t at = 0; at < text.size();)
    {
        const bool begins = at == 0 || kBefore.find(text[at - 1]) != std::string_view::npos;
        const bool is_option = begins && text.compare(at, 2, "--") == 0 && at + 2 < text.size() &&
                               std::islower(static_cast<unsigned char>(text[at + 2])) != 0;
        if (!is_option)
        {
            said += text[at++];
            continue;
        }
        std::size_t end = at + 2;
        while (end < text.size() && is_of_name(text[end]))
        {
            ++end;
        }
        said += name_of(std::string_view(text).substr(at, end - at));
        at = end;
    }
    return said;
}

} // namespace tactus::hrtc
