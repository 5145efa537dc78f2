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

/// What a device told in a recording of `hrtc --record`, frame by frame: that of its tool `tool`,
/// or of its first one where it has no such. Force, torque and rate are those of that run. Where a
/// clutch had parted hand and tool, it is the hand. Logs what of the run is missing. Takes as much
/// memory as the recording, and 250 bytes a frame.
[[nodiscard]] Result<ReplayDeviceOptions, Refusal> read_recorded_motion(const std::string& path,
                                                                        std::size_t tool);

} // namespace tactus::hrtc
