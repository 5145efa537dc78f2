// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/scene_changes.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/frame/frame_parts.hpp"
#include "rt_core/frame/neighbours.hpp"

#include <algorithm>

namespace tactus
{

SceneChanges::SceneChanges(Arena& arena, const FrameSetup& setup) noexcept
    : is_shown_(arena.take<bool>(setup.models.size()))
{
    if (arena.is_measuring())
    {
        return;
    }
    std::ranges::fill(is_shown_, true);
    for (const ToolSpec& tool : setup.tools)
    {
        if (const auto* mesh = std::get_if<MeshCore>(&tool.core); mesh != nullptr)
        {
            is_shown_[mesh->model.value] = false;
        }
    }
}

void SceneChanges::place_first(const FrameSetup& setup, FrameParts& parts,
                               Neighbours& neighbours) noexcept
{
    TACTUS_ASSERT(parts.models.size() == setup.models.size());
    for (std::uint32_t i = 0; i < setup.objects.size(); ++i)
    {
        SceneChange change;
        change.kind = SceneChangeKind::object_comes;
        change.number = i;
        change.object = setup.objects[i];
        change.pose = i < setup.poses.size() ? setup.poses[i] : ObjectPose{};
        parts.objects.make(change, parts.models[change.object.model].header.origin_m(), 0);
        neighbours.place(parts, i);
    }
}

void SceneChanges::make(std::span<const SceneChange> changes, FrameParts& parts,
                        Neighbours& neighbours, SceneOutput& scene) const noexcept
{
    const std::size_t taken = std::min<std::size_t>(changes.size(), kMaxSceneChanges);
    for (const SceneChange& change : changes.first(taken))
    {
        const bool is_of_tool =
            change.kind == SceneChangeKind::tool_comes || change.kind == SceneChangeKind::tool_goes;
        const Refusal refusal = is_of_tool ? try_change_tool(change, parts, neighbours)
                                           : try_change_object(change, parts, neighbours);
        if (refusal)
        {
            ++scene.refused[static_cast<std::size_t>(*refusal)];
        }
    }
    scene.refused[static_cast<std::size_t>(ChangeRefusal::too_many)] +=
        static_cast<std::uint32_t>(changes.size() - taken);
}

SceneChanges::Refusal SceneChanges::try_change_object(const SceneChange& change, FrameParts& parts,
                                                      Neighbours& neighbours) const noexcept
{
    if (const Refusal refusal = parts.objects.find_refusal(change, is_shown_))
    {
        return refusal;
    }
    const Object& object = parts.objects[change.number];
    const bool comes = change.kind == SceneChangeKind::object_comes;
    const ModelId model = comes ? change.object.model : object.spec.model;
    const ObjectPose before = object.pose;
    parts.objects.make(change, parts.models[model].header.origin_m(), parts.rules.frame);
    if (has_pose(change.kind))
    {
        neighbours.place(parts, change.number);
    }
    if (change.kind == SceneChangeKind::object_moves)
    {
        neighbours.look_for_leap(parts, change.number, before);
    }
    if (change.kind == SceneChangeKind::object_goes)
    {
        neighbours.remove(parts, change.number);
    }
    return std::nullopt;
}

SceneChanges::Refusal SceneChanges::try_change_tool(const SceneChange& change, FrameParts& parts,
                                                    Neighbours& neighbours) noexcept
{
    if (change.number >= parts.tools.size())
    {
        return ChangeRefusal::number_too_big;
    }
    const bool comes = change.kind == SceneChangeKind::tool_comes;
    if (parts.tools.status(change.number).is_resident == comes)
    {
        return comes ? ChangeRefusal::already_here : ChangeRefusal::not_here;
    }
    neighbours.forget(parts, change.number);
    parts.tools.renew(change.number, comes);
    return std::nullopt;
}

} // namespace tactus
