// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/neighbours.hpp"

#include "rt_core/frame/frame_parts.hpp"
#include "rt_core/geometry/object_speed_limit.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// Distance beyond the reach, for any speed, at which streamed models are loaded. A user at 2 m/s
/// covers it in 80 ms: a round trip of 20 ms plus request, transfer and entering.
constexpr double kStreamedHorizon_m = 0.16;

/// Bounding sphere of a model's box, in the model's frame.
Sphere model_sphere(const ModelHeader& header) noexcept
{
    const auto& extent = header.fields().extent_quanta;
    const auto quantum_m = static_cast<double>(header.quantum_m());
    const Vec3 half_m = 0.5 * quantum_m * Vec3(extent[0], extent[1], extent[2]);
    return {half_m, half_m.norm()};
}

const ModelHeader& header_of(const FrameParts& parts, std::uint32_t object) noexcept
{
    return parts.models[parts.objects[object].spec.model].header;
}

bool are_paired(const FrameParts& parts, std::uint32_t tool, std::uint32_t object) noexcept
{
    return std::ranges::any_of(parts.pairs.of(tool),
                               [object](const Pair* pair) { return pair->object() == object; });
}

/// Ends the pairs for which `ends` is true; from the last one on, as later pairs move up.
void end_pairs(FrameParts& parts, const auto& ends) noexcept
{
    for (std::size_t i = parts.pairs.all().size(); i > 0; --i)
    {
        if (Pair& pair = *parts.pairs.all()[i - 1]; ends(pair))
        {
            parts.pairs.end(pair, parts.models);
        }
    }
}

} // namespace

Neighbours::Neighbours(Arena& arena, const FrameSetup& setup) noexcept
    : broad_(arena, capacities_of(setup).objects, static_cast<std::uint32_t>(setup.tools.size()))
    , has_streamed_models_(setup.for_streamed_models.base_cells > 0)
{
}

/// Sets the object's bounding sphere in the world, with the rounding of its pose.
void Neighbours::place(const FrameParts& parts, std::uint32_t object) noexcept
{
    const ObjectPose& pose = parts.objects[object].pose;
    const ModelHeader& header = header_of(parts, object);
    const Sphere sphere = model_sphere(header);
    const Vec3 center_m = to_world(pose, sphere.center);
    const double radius_m = pose.scale * sphere.radius;
    const double off_m = pose_rounding_m(pose, center_m, radius_m) +
                         kOriginRounding * header.origin_m().norm() * pose.scale;
    broad_.place(object, {center_m, radius_m + off_m});
}

void Neighbours::look_for_leap(FrameParts& parts, std::uint32_t object,
                               const ObjectPose& before) noexcept
{
    const ObjectPose& now = parts.objects[object].pose;
    const Sphere sphere = model_sphere(header_of(parts, object));
    for (std::uint32_t i = 0; i < parts.tools.size(); ++i)
    {
        if (parts.tools.status(i).is_resident && !are_paired(parts, i, object))
        {
            parts.tools[i].look_for_leap(before, now, sphere);
            const Sphere reach = parts.tools[i].reach_sphere();
            leap_m_[i] =
                std::max(leap_m_[i], way_in_sphere_m(before, now, reach.center, reach.radius));
        }
    }
}

void Neighbours::remove(FrameParts& parts, std::uint32_t object) noexcept
{
    broad_.remove(object);
    for (Pair* pair : parts.pairs.all())
    {
        if (pair->object() == object)
        {
            parts.tools[pair->tool()].forget(pair->placed());
        }
    }
    end_pairs(parts, [object](const Pair& pair) { return pair.object() == object; });
}

void Neighbours::forget(FrameParts& parts, std::uint32_t tool) noexcept
{
    broad_.forget(tool);
    end_pairs(parts, [tool](const Pair& pair) { return pair.tool() == tool; });
}

void Neighbours::find(FrameParts& parts, FrameAccount& account) noexcept
{
    update_tools(parts);
    broad_.walk();
    const Nearness first_out = first_left_out(parts);
    const bool has_room_for_all = first_out == kNothing;
    if (!has_room_for_all || paired_lists_ != broad_.lists())
    {
        pair_up(parts, first_out);
    }
    paired_lists_ = has_room_for_all ? broad_.lists() : 0;
    account.scene.objects = broad_.objects();
    account.scene.pairs = static_cast<std::uint32_t>(parts.pairs.all().size());
    account.scene.walks = broad_.walks();
    find_clearances(parts, first_out, account);
}

/// Sets each tool's search distance: up to surfaces that may matter soon, or to streamed models
/// that should be loading.
void Neighbours::update_tools(const FrameParts& parts) noexcept
{
    for (std::uint32_t i = 0; i < parts.tools.size(); ++i)
    {
        if (parts.tools.status(i).is_resident)
        {
            const Tool& tool = parts.tools[i];
            const bool is_far_of_use =
                tool.spec().wants_distance || !parts.rules.variant.finds_neighbours;
            double near_m = is_far_of_use ? kInfinity : tool.near_m();
            near_m = has_streamed_models_
                         ? std::max(near_m, tool.sphere().radius + tool.placement().reach_m +
                                                kStreamedHorizon_m)
                         : near_m;
            broad_.move_tool(i, tool.sphere().center, near_m);
        }
    }
}

/// Nearness of the nearest pair of tool and near object that does not fit; kNothing if all fit.
Neighbours::Nearness Neighbours::first_left_out(const FrameParts& parts) const noexcept
{
    std::size_t near = 0;
    for (std::uint32_t tool = 0; tool < parts.tools.size(); ++tool)
    {
        near += broad_.near(tool).size();
    }
    if (near <= parts.pairs.capacity())
    {
        return kNothing;
    }
    StaticVector<Nearness, std::size_t{kMaxTools} * kMaxNear> each;
    for (std::uint32_t tool = 0; tool < parts.tools.size(); ++tool)
    {
        for (const std::uint32_t object : broad_.near(tool))
        {
            each.push_back(nearness(parts, tool, object));
        }
    }
    auto* const first_out = each.begin() + parts.pairs.capacity();
    std::nth_element(each.begin(), first_out, each.end());
    return *first_out;
}

/// Distance of the object beyond the tool's reach, with a number that makes all values differ.
Neighbours::Nearness Neighbours::nearness(const FrameParts& parts, std::uint32_t tool,
                                          std::uint32_t object) const noexcept
{
    const double gap_m = broad_.gap_m(tool, object) - parts.tools[tool].sphere().radius -
                         parts.tools[tool].placement().reach_m;
    return {gap_m, tool * kMaxObjects + object};
}

/// Begins missing pairs nearer than `first_out`, and ends all others.
void Neighbours::pair_up(FrameParts& parts, const Nearness& first_out) const noexcept
{
    end_pairs(parts,
              [&](const Pair& pair)
              {
                  return !std::ranges::binary_search(broad_.near(pair.tool()), pair.object()) ||
                         !(nearness(parts, pair.tool(), pair.object()) < first_out);
              });
    for (std::uint32_t tool = 0; tool < parts.tools.size(); ++tool)
    {
        for (const std::uint32_t object : broad_.near(tool))
        {
            if (nearness(parts, tool, object) < first_out && !are_paired(parts, tool, object))
            {
                begin_pair(parts, tool, object);
            }
        }
    }
}

void Neighbours::begin_pair(FrameParts& parts, std::uint32_t tool,
                            std::uint32_t object) const noexcept
{
    const ModelId model = parts.objects[object].spec.model;
    PairParts pair;
    pair.tool_index = tool;
    pair.object_number = object;
    pair.rules = &parts.rules;
    pair.tool = &parts.tools[tool];
    pair.object = &parts.objects[object];
    pair.model = {model, &parts.models[model]};
    pair.begins_apart = begins_apart(parts, tool, object);
    if (const auto* mesh = std::get_if<MeshCore>(&parts.tools[tool].spec().core); mesh != nullptr)
    {
        pair.tool_model = {mesh->model, &parts.models[mesh->model]};
    }
    parts.pairs.begin(pair);
}

/// False in the first frames, for the objects at start. Otherwise true for an object added in this
/// frame, or if the proven clearance is no more than the motion of both since plus the tool's
/// radius.
bool Neighbours::begins_apart(const FrameParts& parts, std::uint32_t tool,
                              std::uint32_t object) const noexcept
{
    const std::uint32_t frame = parts.rules.frame;
    const bool has_moved = parts.objects[object].moved_frame == frame;
    const double ways_m = has_moved ? leap_m_[tool] + parts.tools[tool].went_m() : 0.0;
    return frame > ChunkCache::kFirstFrame + 1 &&
           (parts.objects[object].came_frame == frame ||
            !(parts.tools.status(tool).clear_m - ways_m > parts.tools[tool].radius_m()));
}

/// Finds each tool's clearance from all objects that have no pair with the tool.
void Neighbours::find_clearances(FrameParts& parts, const Nearness& first_out,
                                 FrameAccount& account) noexcept
{
    account.scene.tools_over_capacity = 0;
    account.scene.walled_tools = 0;
    for (std::uint32_t tool = 0; tool < parts.tools.size(); ++tool)
    {
        ToolStatus& status = parts.tools.status(tool);
        leap_m_[tool] = 0.0;
        if (!status.is_resident)
        {
            continue;
        }
        double clear_m = broad_.clear_m(tool);
        for (const std::uint32_t object : broad_.near(tool))
        {
            const bool is_pair = first_out == kNothing || nearness(parts, tool, object) < first_out;
            clear_m = is_pair ? clear_m : std::min(clear_m, broad_.gap_m(tool, object));
        }
        status.clear_m = clear_m - parts.tools[tool].sphere().radius;
        status.exceeds_capacity = status.clear_m < parts.tools[tool].placement().reach_m;
        account.scene.tools_over_capacity += status.exceeds_capacity ? 1U : 0U;
        account.faults |=
            status.exceeds_capacity ? FrameFault::scene_over_capacity : FrameFault::none;
        const auto pairs = static_cast<std::uint32_t>(parts.pairs.of(tool).size());
        account.work.skipped.add(Skip::objects, account.scene.objects - pairs);
    }
}

} // namespace tactus
