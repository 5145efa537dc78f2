// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"
#include "platform/recording/recording.hpp"
#include "rt_core/base/result.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tactus::hrtc
{

/// Most repetitions of a suspected frame. Work that takes too long does so each time. A delay by
/// the machine does not occur each time, and never shortens the work.
inline constexpr int kRepetitions = 5;

/// Replays a run. Returns those of the frames `suspects` (ascending) that took more than `limit` of
/// processor time in each of kRepetitions. Refused if the recording can't be replayed, if a replay
/// differs, or if a suspect is missing in the recording.
[[nodiscard]] Result<std::vector<std::uint64_t>, std::string>
frames_over_again(const Recording& recording, std::span<const std::uint64_t> suspects,
                  Duration limit);

} // namespace tactus::hrtc
