// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/telemetry_tap.hpp"

#include "rt_core/base/assert.hpp"

#include <array>
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

PoolTelemetry pool_of(const PoolUse& use) noexcept
{
    return {use.used, use.capacity};
}

ToolTelemetry tool_of(const ToolState& state, const Vec3& sent_n, const ToolOutput& output) noexcept
{
    ToolTelemetry tool;
    tool.position_m = parts_of(state.position_m);
    tool.proxy_m = parts_of(output.proxy_m);
    tool.force_n = parts_of(sent_n);
    tool.torque_nm = parts_of(output.torque_nm);
    tool.in_contact = output.in_contact;
    tool.frozen = output.frozen;
    tool.squeezed = output.squeezed;
    tool.held_back = output.held_back;
    return tool;
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
    TACTUS_ASSERT(frame.output.models.size() <= kMaxObjects);
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
    news_.model_count = static_cast<std::uint32_t>(frame.output.models.size());
    for (std::size_t i = 0; i < frame.tools.size(); ++i)
    {
        news_.tools[i] = tool_of(frame.tools[i], frame.forces[i].sent_n, frame.output.tools[i]);
    }
    for (std::size_t i = 0; i < frame.output.models.size(); ++i)
    {
        news_.models[i] = model_of(frame.output.models[i]);
        news_.models[i].pose_age_ns = frame.poses[i].age_ns;
    }
    mailbox_.write(news_);
}

} // namespace tactus::hrtc
