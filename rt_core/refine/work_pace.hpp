// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"

#include <cstdint>

namespace tactus
{

/// How much of what may wait a frame does: splits ahead of the tools, and merges behind them. Half
/// as much again as was split in a frame lately, so what piles up goes down, and no frame has much
/// more to do than the others. Part of the frame's state: integers, so that a replay agrees.
class WorkPace
{
public:
    /// A frame split so many.
    void count(std::uint32_t splits) noexcept TACTUS_NONBLOCKING;

    /// Up to how many splits, of a budget of at most a million, a frame goes on with what may wait:
    /// an eighth of it at least, so that the first frames of a motion have some, and two fifths at
    /// most.
    [[nodiscard]] std::uint32_t splits_of(std::uint32_t budget) const noexcept TACTUS_NONBLOCKING;

    /// The same of merges, which make room for splits: fewer after a frame that split many, a
    /// sixteenth at least.
    [[nodiscard]] std::uint32_t merges_of(std::uint32_t budget) const noexcept TACTUS_NONBLOCKING;

private:
    std::uint32_t mean_{0}; ///< Of the splits a frame, in parts of one.
    std::uint32_t last_{0}; ///< The last frame's.
};

} // namespace tactus
