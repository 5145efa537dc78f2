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

    /// Number of the frame's splits up to which splits that may wait are done, of a budget of at
    /// most a million. At least an eighth of the budget, so that the first frames of a motion have
    /// some, and at most two fifths.
    [[nodiscard]] std::uint32_t splits_of(std::uint32_t budget) const noexcept TACTUS_NONBLOCKING;

    /// Number of merges that a frame may do, of the same kind of budget. Fewer after a frame with
    /// many splits; at least a sixteenth of the budget.
    [[nodiscard]] std::uint32_t merges_of(std::uint32_t budget) const noexcept TACTUS_NONBLOCKING;

private:
    std::uint32_t mean_{0}; ///< Mean of splits per frame, in 1/256.
    std::uint32_t last_{0}; ///< Splits of the last frame.
};

} // namespace tactus
