// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/records/work_budget.hpp"

#include <cstdint>

namespace tactus
{

/// How far each stage of a frame may go in the frame's work, so that something is left for those
/// that follow. While it refines, a frame keeps what its queries and forces took in the last one.
/// Haptic thread.
class WorkShares
{
public:
    /// A frame begins that may do `most`, WorkBudget::kLeast at least; `work` is its count, and
    /// outlives the frame.
    void begin(std::uint32_t most, WorkBudget& work) noexcept TACTUS_NONBLOCKING;
    void begin_loading() noexcept TACTUS_NONBLOCKING;
    void begin_refining() noexcept TACTUS_NONBLOCKING;
    void begin_queries() noexcept TACTUS_NONBLOCKING;
    /// A query begins that so many others follow.
    void begin_query(std::uint32_t later) noexcept TACTUS_NONBLOCKING;
    void begin_forces() noexcept TACTUS_NONBLOCKING;
    void end() noexcept TACTUS_NONBLOCKING;

    /// Planes that a proxy may look at now; it stays where it is with fewer than the least.
    [[nodiscard]] std::uint32_t planes() const noexcept TACTUS_NONBLOCKING;
    /// What may be done between this frame and the next.
    [[nodiscard]] WorkBudget for_rehearsal() const noexcept TACTUS_NONBLOCKING;

private:
    [[nodiscard]] std::uint32_t part(double share) const noexcept;

    WorkBudget* work_{nullptr};
    std::uint32_t most_{0};
    std::uint32_t query_most_{0};     ///< All queries together may go so far.
    std::uint32_t before_answers_{0}; ///< What was done when the queries began.
    std::uint32_t answers_{0};        ///< What the last frame's queries and forces took.
};

} // namespace tactus
