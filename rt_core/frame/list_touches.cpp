// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/list_touches.hpp"

#include "rt_core/frame/frame.hpp"
#include "rt_core/geometry/object_speed_limit.hpp"

#include <algorithm>

namespace tactus
{

void list_touches(const Frame& frame, std::span<const PairOutput> pairs,
                  const ObjectSpeedLimit& belief, ObjectTouches& touches) noexcept
{
    touches.clear();
    for (const bool is_near : {true, false})
    {
        for (const PairOutput& pair : pairs)
        {
            const Tool& tool = frame.tool(pair.tool);
            const double radius_m = tool.spec().radius_m;
            const double soon_m = std::max(belief.soon_m(tool.speed_m_per_s()), tool.leap_m());
            if (!tool.spec().query_only && pair.lower_m <= radius_m + kTouchSlack_m + soon_m &&
                is_in_reach(pair, radius_m) == is_near)
            {
                const Sphere reach = tool.reach_sphere();
                touches.push_back({pair.object, pair.tool, reach.center, reach.radius, is_near});
            }
        }
    }
}

} // namespace tactus
