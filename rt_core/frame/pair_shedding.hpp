// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/records/priority.hpp"

#include <cstdint>
#include <span>

namespace tactus
{

class Pair;

/// Sheds pairs: those of lowest priority are not loaded or refined while pairs of higher priority
/// lack memory.
///
/// A shed pair resumes after kCalmFrames without a refusal for a contact. This wait doubles each
/// time that a pair resumed too soon. Cost: linear in the pairs.
class PairShedding
{
public:
    /// Sheds as many pairs as needed, from the end of `order`, which is sorted by priority. True if
    /// any pair is shed.
    [[nodiscard]] bool shed(std::span<Pair* const> order) noexcept TACTUS_NONBLOCKING;
    /// Learns from a refinement. `refused` is the highest priority class for which a face did not
    /// fit; kPriorityClasses: none. One more pair is shed if the class is `touching` or `soon`.
    void learn(std::uint32_t refused) noexcept TACTUS_NONBLOCKING;

private:
    static constexpr std::uint32_t kCalmFrames = 64;
    static constexpr std::uint32_t kCalmFramesMost = 64 * kCalmFrames;

    /// Number of pairs to shed, of classes later than below_.
    std::uint32_t count_{0};
    PriorityClass below_{PriorityClass::touching};
    /// Frames since a face was last refused to a contact, or a pair resumed.
    std::uint32_t calm_frames_{0};
    std::uint32_t patience_{kCalmFrames}; ///< Number of calm frames until the next pair resumes.
    bool has_come_back_{false}; ///< True if a pair has resumed since the last one was shed.
};

} // namespace tactus
