// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/telemetry_from_frame.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace tactus
{

namespace
{

std::array<double, 4> quaternion_of(const Mat3& rotation) noexcept
{
    const Eigen::Quaterniond q(rotation);
    return {q.x(), q.y(), q.z(), q.w()};
}

PoolTelemetry pool_of(const PoolUse& use) noexcept
{
    return {use.used, use.capacity};
}

} // namespace

ToolTelemetry telemetry_of(const ToolState& state, const DeviceRecord& device,
                           const ToolOutput& output) noexcept
{
    ToolTelemetry tool;
    tool.position_m = parts_of(state.position_m);
    tool.rotation = quaternion_of(state.rotation);
    tool.proxy_m = parts_of(output.proxy_m);
    tool.proxy_rotation = quaternion_of(output.proxy_rotation);
    tool.force_n = parts_of(device.sent_n);
    tool.torque_nm = parts_of(device.sent_nm);
    tool.buttons = device.buttons;
    // A number that is not finite is never sent.
    tool.has_gripper = device.gripper_m && std::isfinite(*device.gripper_m);
    tool.gripper_m = tool.has_gripper ? *device.gripper_m : 0.0;
    tool.in_contact = output.in_contact;
    tool.halted = output.halted;
    tool.over_constrained = output.over_constrained;
    tool.data_limited = output.data_limited;
    return tool;
}

PairTelemetry telemetry_of(const PairOutput& output) noexcept
{
    PairTelemetry pair;
    pair.object = output.object;
    pair.tool = static_cast<std::uint8_t>(output.tool);
    pair.kind = output.kind;
    pair.lower_m = output.lower_m;
    pair.upper_m = output.upper_m;
    pair.point_m = parts_of(output.nearest_point_m);
    return pair;
}

ModelTelemetry telemetry_of(const ModelOutput& output) noexcept
{
    ModelTelemetry model;
    model.pages = pool_of(output.pages);
    model.faces = pool_of(output.faces);
    model.blocks = pool_of(output.blocks);
    model.nodes = pool_of(output.nodes);
    model.is_static = output.is_static;
    model.stage = output.stage;
    return model;
}

Pose source_pose_of(const Similarity& place, const Vec3& origin_m) noexcept
{
    return {quaternion_of(place.rotation), parts_of(place.local_to_world(-origin_m)), place.scale};
}

Pose frame_pose_of(const Pose& source, const Vec3& origin_m) noexcept
{
    const auto& q = source.rotation;
    const Vec3 rotated_m = Eigen::Quaterniond(q[3], q[0], q[1], q[2]) * origin_m;
    Pose frame = source;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        frame.translation_m[axis] += source.scale * rotated_m[static_cast<int>(axis)];
    }
    return frame;
}

} // namespace tactus
