// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "rt_core/records/frame_output.hpp"

#include <cstdint>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// Where a tool touches an object, in the world.
struct ObjectTouch
{
    std::uint32_t object{0};
    Vec3 place_m{0.0, 0.0, 0.0};
};

/// What a tool may go in a frame, and the skin of one without a radius.
inline constexpr double kTouchSlack_m = 5e-3;

/// Whether the surface may be at the tool, which has this radius, at the end of the frame: pairs
/// are measured at its beginning.
[[nodiscard]] inline bool is_in_reach(const PairOutput& pair, double radius_m) noexcept
{
    return pair.lower_m <= radius_m + kTouchSlack_m;
}

/// Whether the pair's tool, of which the output is, may touch the object.
[[nodiscard]] inline bool may_touch(const PairOutput& pair, const ToolOutput& tool,
                                    double radius_m) noexcept
{
    return tool.in_contact && is_in_reach(pair, radius_m);
}

} // namespace tactus
