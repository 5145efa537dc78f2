// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/device_record.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"
#include "transport/pose.hpp"
#include "transport/telemetry.hpp"

// Any thread, including the haptic one: no call waits or allocates, and results depend on the
// arguments alone.
namespace tactus
{

/// Telemetry of one tool, pair or model of a frame. Fields that the frame does not know (server,
/// poses, pieces) stay zero; objects have the controller's numbers.
[[nodiscard]] ToolTelemetry telemetry_of(const ToolState& state, const DeviceRecord& device,
                                         const ToolOutput& output) noexcept;
[[nodiscard]] PairTelemetry telemetry_of(const PairOutput& output) noexcept;
[[nodiscard]] ModelTelemetry telemetry_of(const ModelOutput& output) noexcept;

/// Pose of an object's source mesh. `place` is that of its model's frame, whose origin in the
/// source mesh is `origin_m` (ModelHeader::origin_m).
[[nodiscard]] Pose source_pose_of(const Similarity& place, const Vec3& origin_m) noexcept;
/// Pose of the model's frame: the inverse of source_pose_of().
[[nodiscard]] Pose frame_pose_of(const Pose& source, const Vec3& origin_m) noexcept;

[[nodiscard]] inline std::array<double, 3> parts_of(const Vec3& vector) noexcept
{
    return {vector.x(), vector.y(), vector.z()};
}

} // namespace tactus
