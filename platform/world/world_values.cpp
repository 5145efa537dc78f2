// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/world/world_values.hpp"

#include "platform/scene/material_limits.hpp"
#include "platform/scene/object_pose.hpp"
#include "rt_core/math/rotation.hpp"
#include "transport/material_ranges.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

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

} // namespace tactus
