// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/simulated/replay_device.hpp"
#include "platform/recording/recording.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstddef>
#include <string>

namespace tactus::hrtc
{

/// Reads the samples of a device from a recording of `hrtc --record`, one a frame. The device is
/// that of tool `tool`, or of the first tool if there is no such tool. Largest force, largest
/// torque and rate are those of the recorded run. With a clutch, the pose is the device pose, not
/// the tool's. Logs missing parts of the recording. Takes as much memory as the recording, and 250
/// bytes a frame.
[[nodiscard]] Result<ReplayDeviceOptions, Refusal> read_recorded_motion(const std::string& path,
                                                                        std::size_t tool);

} // namespace tactus::hrtc
