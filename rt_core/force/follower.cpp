// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/follower.hpp"

namespace tactus
{

void Follower::see(const ProxyGoal& goal) noexcept
{
    way_m_ = 0.0;
    if (goal.change == GoalChange::motion)
    {
        const Vec3 way = goal.position_m - place_.translation_m;
        way_m_ = PlacedCore(core_, {goal.rotation, way})
                     .motion_since(PlacedCore(core_, {place_.rotation, Vec3(0.0, 0.0, 0.0)}));
    }
    place_ = {goal.rotation, goal.position_m, 1.0};
}

ToolOutput Follower::respond(const ProxyGoal& goal, std::span<const PlacedSurface> surfaces,
                             double /*clear_m*/) const noexcept
{
    ToolOutput output;
    output.proxy_m = goal.position_m;
    output.proxy_rotation = goal.rotation;
    for (const PlacedSurface& placed : surfaces)
    {
        output.in_contact = output.in_contact || placed.upper_m <= radius_m_;
    }
    return output;
}

} // namespace tactus
