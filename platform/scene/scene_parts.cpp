// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/scene/scene_parts.hpp"

#include "rt_core/math/rotation.hpp"

#include <variant>

namespace tactus::hrtc
{

bool is_of_tool(std::span<const ToolSetup> tools, std::size_t model) noexcept
{
    return std::ranges::any_of(tools,
                               [model](const ToolSetup& tool)
                               {
                                   const auto* mesh = std::get_if<MeshCore>(&tool.spec.core);
                                   return mesh != nullptr && mesh->model.value == model;
                               });
}

Similarity to_similarity(const Pose& pose)
{
    const auto& at = pose.translation_m;
    Similarity place;
    place.rotation = to_rotation(pose.rotation);
    place.translation_m = Vec3(at[0], at[1], at[2]);
    place.scale = pose.scale;
    return place;
}

ObjectPose object_pose(const Similarity& place, const ModelHeader& header)
{
    ObjectPose pose{place};
    pose.revision = header.fields().revision;
    return pose;
}

} // namespace tactus::hrtc
