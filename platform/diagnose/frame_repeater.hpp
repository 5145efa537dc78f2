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

/// How often a frame under suspicion is repeated at most. Work that takes too long does so every
/// time; what a machine adds it does not add always, and it takes nothing away.
inline constexpr int kRepetitions = 5;

/// Replays a run and returns which of the frames `suspects` (ascending) took more than `limit` of
/// processor time in each of kRepetitions. Refused when the recording can't be replayed or
/// comes out otherwise, and when a suspect is not in it.
[[nodiscard]] Result<std::vector<std::uint64_t>, std::string>
frames_over_again(const Recording& recording, std::span<const std::uint64_t> suspects,
                  Duration limit);

} // namespace tactus::hrtc
