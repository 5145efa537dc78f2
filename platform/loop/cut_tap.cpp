// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/cut_tap.hpp"

#include "platform/devices/device_force.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/object_touch.hpp"

#include <algorithm>

namespace tactus::hrtc
{

namespace
{

static_assert(kMaxTools <= 32); // One bit each in cutting_.

/// Pair of the object that the tool may touch with the least distance; null if there is none.
const PairOutput* nearest_touched(const CutFrame& frame, std::uint32_t tool) noexcept
{
    const PairOutput* nearest = nullptr;
    for (const PairOutput& pair : frame.output.pairs)
    {
        if (pair.tool == tool && pair.is_joined &&
            may_touch(pair, frame.output.tools[tool], frame.radii_m[tool]) &&
            (nearest == nullptr || pair.lower_m < nearest->lower_m))
        {
            nearest = &pair;
        }
    }
    return nearest;
}

} // namespace

void CutTap::show(const CutFrame& frame) noexcept
{
    for (std::uint32_t tool = 0; tool < frame.output.tools.size(); ++tool)
    {
        const ToolOutput& output = frame.output.tools[tool];
        // Surfaces push the hand along the spring's force; a withheld force cuts nothing.
        const double spring_n = output.force_n.norm();
        const double force_n = std::min(spring_n, frame.forces[tool].push.force_n.norm());
        const PairOutput* const pair =
            (cutting_ >> tool & 1U) != 0 && force_n > 0.0 ? nearest_touched(frame, tool) : nullptr;
        if (pair == nullptr)
        {
            continue;
        }
        const Object& object = frame.objects[pair->object];
        const Mat3 to_model = object.pose.rotation.transpose();
        const Eigen::Quaterniond rotation(Mat3(to_model * output.proxy_rotation));
        const CutSample sample{.tool = tool,
                               .object = pair->object,
                               .model = object.spec.model,
                               .time_ns = frame.time_ns,
                               .scale = object.pose.scale,
                               .proxy_m = to_array(object.pose.world_to_local(output.proxy_m)),
                               .rotation = {rotation.x(), rotation.y(), rotation.z(), rotation.w()},
                               .push = to_array(to_model * (output.force_n / -spring_n)),
                               .force_n = force_n};
        if (!samples_.try_push(sample))
        {
            lost_.fetch_add(1, std::memory_order_relaxed);
        }
    }
}

} // namespace tactus::hrtc
