// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/frame/pair.hpp"
#include "rt_core/records/priority.hpp"

#include <cstdint>
#include <span>

namespace tactus
{

/// Takes resources from the pairs of lowest priority while those of higher priority lack them.
///
/// A waiting pair gets its resources back after kCalmFrames without a refusal for a contact, and
/// after twice as many each time that this was too soon.
class PairShedding
{
public:
    /// Lets as many pairs wait as needed; `order`: the highest priority first. True if there are
    /// any.
    [[nodiscard]] bool shed(std::span<Pair* const> order) noexcept TACTUS_NONBLOCKING;
    /// Learns from the refinement. `refused` is the class of highest priority with a refused page
    /// or face, kPriorityClasses if none: one pair more waits if it was a contact or an imminent
    /// one.
    void learn(std::uint32_t refused) noexcept TACTUS_NONBLOCKING;

private:
    static constexpr std::uint32_t kCalmFrames = 64;
    static constexpr std::uint32_t kCalmFramesMost = 64 * kCalmFrames;

    /// Waiting pairs, of classes below below_.
    std::uint32_t count_{0};
    PriorityClass below_{PriorityClass::touching};
    /// Frames since a contact was last refused, or a pair resumed.
    std::uint32_t calm_frames_{0};
    std::uint32_t patience_{kCalmFrames}; ///< Calm frames until the next pair resumes.
    bool has_come_back_{false};           ///< A pair has resumed since the last was shed.
};

} // namespace tactus
