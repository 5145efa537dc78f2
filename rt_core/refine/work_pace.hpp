// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"

#include <cstdint>

namespace tactus
{

/// Steady pace for work that may wait: splits ahead of the tools, and merges behind them. A frame
/// does up to one and a half times the recent mean of splits, so a backlog shrinks and no frame has
/// much more to do than the others. Part of the frame's state: integers, so that a replay agrees.
class WorkPace
{
public:
    /// Records the splits of a frame.
    void count(std::uint32_t splits) noexcept TACTUS_NONBLOCKING;

    /// Number of splits, of a budget of at most a million, up to which a frame does splits that may
    /// wait: at least an eighth of the budget, so that the first frames of a motion have some, and
    /// at most two fifths.
    [[nodiscard]] std::uint32_t splits_of(std::uint32_t budget) const noexcept TACTUS_NONBLOCKING;

    /// The same for merges, which make room for splits: fewer after a frame that split many, at
    /// least a sixteenth.
    [[nodiscard]] std::uint32_t merges_of(std::uint32_t budget) const noexcept TACTUS_NONBLOCKING;

private:
    std::uint32_t mean_{0}; ///< Moving average of splits per frame, fixed point.
    std::uint32_t last_{0}; ///< Splits of the last frame.
};

} // namespace tactus
