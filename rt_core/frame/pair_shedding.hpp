// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/frame/pair.hpp"
#include "rt_core/records/urgency.hpp"

#include <cstdint>
#include <span>

namespace tactus
{

/// Takes from the least urgent pairs what more urgent ones had no room for, while there are such.
///
/// A pair that waits gets its room back after kCalmFrames in which no touch lacked any, and after
/// twice as many each time that this was too soon.
class PairShedding
{
public:
    /// Lets so many of the pairs wait as are needed; `order`: the most urgent first. Whether there
    /// are any.
    [[nodiscard]] bool shed(std::span<Pair* const> order) noexcept TACTUS_NONBLOCKING;
    /// After the refinement. `refused` is the most urgent class of those that found no room for a
    /// page or a face, kUrgencyClasses where none was refused: one pair more waits when it was a
    /// touch, or what will be one soon.
    void learn(std::uint32_t refused) noexcept TACTUS_NONBLOCKING;

private:
    static constexpr std::uint32_t kCalmFrames = 64;
    static constexpr std::uint32_t kCalmFramesMost = 64 * kCalmFrames;

    std::uint32_t count_{0}; ///< So many pairs of classes below below_ wait.
    UrgencyClass below_{UrgencyClass::touching};
    std::uint32_t calm_frames_{0}; ///< Since a touch was last refused room, or a pair came back.
    std::uint32_t patience_{kCalmFrames}; ///< Calm frames until the next one comes back.
    bool has_come_back_{false};           ///< One has, since the last was shed.
};

} // namespace tactus
