// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/base/refusal.hpp"
#include "platform/recording/recording.hpp"
#include "platform/simulated/replay_device.hpp"
#include "rt_core/base/result.hpp"

#include <cstddef>
#include <string>

namespace tactus::hrtc
{

/// What moved a tool in a recording of `hrtc --record`, frame by frame: of its tool `tool`, or of
/// its first one where it has no such. Force and rate are those of that run. Takes as much memory
/// as the recording, and 40 bytes a frame.
[[nodiscard]] Result<ReplayDeviceOptions, Refusal> read_recorded_motion(const std::string& path,
                                                                        std::size_t tool);

} // namespace tactus::hrtc
