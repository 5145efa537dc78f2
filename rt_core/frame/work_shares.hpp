// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/records/work_budget.hpp"

#include <cstdint>

namespace tactus
{

/// Limits the share of a frame's work for each stage, so that some is left for the stages that
/// follow. Refinement leaves as much as the last frame's queries and forces used. Haptic thread.
class WorkShares
{
public:
    /// Begins a frame with a limit of `most`, or WorkBudget::kLeast if that is more. `work` counts
    /// the frame's work and outlives the frame.
    void begin(std::uint32_t most, WorkBudget& work) noexcept TACTUS_NONBLOCKING;
    void begin_loading() noexcept TACTUS_NONBLOCKING;
    void begin_refining() noexcept TACTUS_NONBLOCKING;
    void begin_queries() noexcept TACTUS_NONBLOCKING;
    /// Begins a query; `later` is the number of queries that follow it.
    void begin_query(std::uint32_t later) noexcept TACTUS_NONBLOCKING;
    void begin_forces() noexcept TACTUS_NONBLOCKING;
    void end() noexcept TACTUS_NONBLOCKING;

    /// Number of planes that a proxy may check now, kPlanesLeast at least.
    [[nodiscard]] std::uint32_t planes() const noexcept TACTUS_NONBLOCKING;
    /// Budget for Frame::warm_caches(), between this frame and the next.
    [[nodiscard]] WorkBudget for_warming() const noexcept TACTUS_NONBLOCKING;

private:
    [[nodiscard]] std::uint32_t part(double share) const noexcept;

    WorkBudget* work_{nullptr};
    std::uint32_t most_{0};
    std::uint32_t query_most_{0};     ///< Limit of the frame's work at the end of all queries.
    std::uint32_t before_answers_{0}; ///< Work of this frame when its queries began.
    std::uint32_t answers_{0};        ///< Work of the last frame's queries and forces.
};

} // namespace tactus
