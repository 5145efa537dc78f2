// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/static_vector.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/frame_output.hpp"

#include <cstdint>

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
