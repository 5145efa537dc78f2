// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/scene/scene.hpp"

#include <algorithm>

namespace tactus
{

Scene::Scene(std::span<const ToolSpec> tools, std::span<const ObjectSpec> objects) noexcept
{
    for (const ToolSpec& tool : tools)
    {
        tools_.push_back(tool);
    }
    for (const ObjectSpec& object : objects)
    {
        objects_.push_back(object);
    }
    for (std::uint32_t tool = 0; tool < tools_.size(); ++tool)
    {
        for (std::uint32_t object = 0; object < objects_.size(); ++object)
        {
            ScenePair pair;
            pair.tool = tool;
            pair.object = object;
            pairs_.push_back(pair);
        }
    }
}

void Scene::describe_meshes(const MeshCore& core) noexcept
{
    for (ToolSpec& tool : tools_)
    {
        auto* mesh = std::get_if<MeshCore>(&tool.core);
        if (mesh != nullptr && mesh->model == core.model)
        {
            *mesh = core;
        }
    }
}

void Scene::place(ScenePair& pair, const ObjectPose& pose, const Mat3& rotation,
                  const Vec3& position_m, double reach_m, const Vec3& ahead_m) const noexcept
{
    const ToolSpec& tool = tools_[pair.tool];
    pair.core = PlacedCore(tool.core, place_in_model(pose, rotation, position_m));
    pair.cover = pair.core.cover(tool.radius_m / pose.scale);
    pair.reach_m = reach_m / pose.scale;
    pair.ahead_m = (pose.rotation.transpose() * ahead_m) / pose.scale;
    const double awake_m = kKeepFactor * pair.reach_m + pair.ahead_m.norm();
    pair.is_asleep = pair.has_known && pair.known.lower_m - pair.motion_m() > awake_m;
}

void Scene::remember(ScenePair& pair, const DistanceAnswer& answer) noexcept
{
    pair.known = answer;
    pair.known_core = pair.core;
    pair.has_known = true;
}

DistanceAnswer Scene::from_motion(const ScenePair& pair) noexcept
{
    const double motion = pair.motion_m();
    DistanceAnswer answer;
    answer.lower_m = std::max(0.0, pair.known.lower_m - motion);
    answer.upper_m = pair.known.upper_m + motion;
    answer.kind = answer.lower_m > pair.reach_m ? AnswerKind::decided : AnswerKind::bracket;
    answer.tool_point_m = pair.core.center();
    return answer;
}

} // namespace tactus
