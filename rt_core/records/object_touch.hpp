// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/static_vector.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/frame_output.hpp"

#include <cstdint>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// A tool and an object that touch, or may touch within ObjectSpeedLimit::kPatience_s. World frame.
struct ObjectTouch
{
    std::uint32_t object{0};
    std::uint32_t tool{0};
    /// Sphere that holds the tool and all of the object that it may meet in a frame.
    Vec3 place_m{0.0, 0.0, 0.0};
    double radius_m{0.0};
    bool is_in_reach{true}; ///< The object may reach the tool in this frame.
};
using ObjectTouches = StaticVector<ObjectTouch, kMaxPairs>;

/// Largest displacement of a tool in a frame, and the skin of a tool without a radius.
inline constexpr double kTouchSlack_m = 5e-3;

/// True if the surface may reach the tool, which has this radius, by the end of the frame; pairs
/// are measured at its beginning.
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
