// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/telemetry_tap.hpp"

#include "platform/hrtc/touch_forces.hpp"
#include "rt_core/base/assert.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace tactus::hrtc
{

namespace
{

std::array<double, 3> parts_of(const Vec3& vector) noexcept
{
    return {vector.x(), vector.y(), vector.z()};
}

std::array<double, 4> quaternion_of(const Mat3& rotation) noexcept
{
    const Eigen::Quaterniond q(rotation);
    return {q.x(), q.y(), q.z(), q.w()};
}

PoolTelemetry pool_of(const PoolUse& use) noexcept
{
    return {use.used, use.capacity};
}

ToolTelemetry tool_of(const ToolState& state, const DeviceRecord& device,
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
    // Nobody sends what is no number.
    tool.has_gripper = device.gripper_m && std::isfinite(*device.gripper_m);
    tool.gripper_m = tool.has_gripper ? *device.gripper_m : 0.0;
    tool.in_contact = output.in_contact;
    tool.frozen = output.frozen;
    tool.squeezed = output.squeezed;
    tool.held_back = output.held_back;
    return tool;
}

PairTelemetry pair_of(const PairOutput& output) noexcept
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

ModelTelemetry model_of(const ModelOutput& output) noexcept
{
    ModelTelemetry model;
    model.pages = pool_of(output.pages);
    model.faces = pool_of(output.faces);
    model.blocks = pool_of(output.blocks);
    model.nodes = pool_of(output.nodes);
    model.is_static = output.is_static;
    return model;
}

} // namespace

void TelemetryTap::show(const ShownFrame& frame, const RunStatistics& statistics) noexcept
{
    TACTUS_ASSERT(frame.tools.size() <= kMaxTools);
    TACTUS_ASSERT(frame.output.pairs.size() <= kMaxPairs);
    news_.frame = statistics.frames;
    news_.time_ns = frame.start.ns;
    news_.exact = statistics.answers.exact;
    news_.decided = statistics.answers.decided;
    news_.bracket = statistics.answers.bracket;
    news_.stale = statistics.answers.stale;
    news_.missed = statistics.deadlines.missed;
    news_.own_faults = statistics.deadlines.own_faults;
    news_.machine_late = statistics.deadlines.machine_late;
    news_.faults_now = static_cast<std::uint32_t>(frame.output.faults);
    news_.faults_seen |= news_.faults_now;
    news_.tool_count = static_cast<std::uint32_t>(frame.tools.size());
    news_.pair_count = static_cast<std::uint32_t>(frame.output.pairs.size());
    news_.model_count = static_cast<std::uint32_t>(
        std::min<std::size_t>(frame.output.models.size(), kMaxShownModels));
    for (std::size_t i = 0; i < frame.tools.size(); ++i)
    {
        news_.tools[i] = tool_of(frame.tools[i], frame.devices[i], frame.output.tools[i]);
    }
    for (std::size_t i = 0; i < news_.model_count; ++i)
    {
        news_.models[i] = model_of(frame.output.models[i]);
    }
    show_pairs(frame);
    mailbox_.write(news_);
}

void TelemetryTap::show_pairs(const ShownFrame& frame) noexcept
{
    const std::span<const PairOutput> pairs = frame.output.pairs;
    std::array<Vec3, kMaxPairs> pushes_n;
    for (std::size_t begin = 0; begin < pairs.size();) // They are sorted by tools.
    {
        const std::uint32_t tool = pairs[begin].tool;
        std::size_t end = begin + 1;
        while (end < pairs.size() && pairs[end].tool == tool)
        {
            ++end;
        }
        const Vec3 push_n = frame.output.tools[tool].in_contact ? Vec3(-frame.devices[tool].sent_n)
                                                                : Vec3(0.0, 0.0, 0.0);
        share_push(pairs.subspan(begin, end - begin), frame.radii_m[tool], push_n,
                   std::span(pushes_n).subspan(begin, end - begin));
        begin = end;
    }
    for (std::size_t i = 0; i < pairs.size(); ++i)
    {
        news_.pairs[i] = pair_of(pairs[i]);
        news_.pairs[i].force_n = parts_of(pushes_n[i]);
    }
}

} // namespace tactus::hrtc
