// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/static_vector.hpp"
#include "rt_core/geometry/object_speed_limit.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/similarity.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/frame_output.hpp"

#include <algorithm>
#include <cstdint>
#include <span>

// Usable on any thread: plain values and pure functions. No call waits or allocates.
namespace tactus
{

/// A tool and an object that touch, or may touch within ObjectSpeedLimit::kPatience_s. World frame.
struct ObjectTouch
{
    std::uint32_t object{0};
    std::uint32_t tool{0};
    /// Sphere that holds the tool and all points of the object that the tool may meet in a frame.
    Vec3 place_m{0.0, 0.0, 0.0};
    double radius_m{0.0};
    bool is_in_reach{true}; ///< True if the object may reach the tool in this frame.
};
using ObjectTouches = StaticVector<ObjectTouch, kMaxPairs>;

/// Largest displacement, in metres, that a move of the object causes where a tool may meet it; 0 if
/// no touch is the object's.
[[nodiscard]] inline double way_at_touches_m(std::span<const ObjectTouch> touches,
                                             std::uint32_t object, const Similarity& from,
                                             const Similarity& to) noexcept
{
    double way_m = 0.0;
    for (const ObjectTouch& touch : touches)
    {
        if (touch.object == object)
        {
            way_m = std::max(way_m, way_in_sphere_m(from, to, touch.place_m, touch.radius_m));
        }
    }
    return way_m;
}

/// Distance beyond a tool's radius for its displacement in a frame and for the skin of a tool
/// without a radius.
inline constexpr double kTouchSlack_m = 5e-3;

/// True if the surface may reach a tool of this radius by the end of the frame. A pair's distance
/// is that at the frame's beginning.
[[nodiscard]] inline bool is_in_reach(const PairOutput& pair, double radius_m) noexcept
{
    return pair.lower_m <= radius_m + kTouchSlack_m;
}

/// True if the pair's tool, with this output, may touch the object.
[[nodiscard]] inline bool may_touch(const PairOutput& pair, const ToolOutput& tool,
                                    double radius_m) noexcept
{
    return tool.in_contact && is_in_reach(pair, radius_m);
}

} // namespace tactus
