// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/frame_cost_model.hpp"
#include "platform/time.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/work_counters.hpp"

#include <cstdint>

namespace tactus
{

/// What one frame took and did.
struct FrameCost
{
    Duration frame;  ///< As a whole: what has to fit.
    Duration walked; ///< Refine, refit and query: edits and steps of traversals.
    Duration force;  ///< The stage that planes bound.
    WorkCounters work;
};

/// Chooses the budgets of each frame from what the frames before it took, so that a frame fits into
/// a set time: splits, merges, scanned records, nodes, triangles and planes. It works between
/// frames and has no clock: the budgets are inputs of the frame like any other, and can be
/// recorded.
///
/// What is left of the time after the stages that it does not govern, after the traversals and
/// planes that are usual, and after a reserve for scatter, is given to splits and merges; both may
/// be spent in full. A traversal may use what a frame without edits would leave; proxies what is
/// left without their planes and a frame's edits, and half of it at least. Budgets fall to their
/// new value at once and rise by a sixteenth of the way a frame, never above those given at the
/// start and never below a floor, so the front moves in every frame even where the time is too
/// short.
///
/// A single frame of more than kStall times the set time is taken for the machine's and teaches
/// nothing; a second one in a row counts. Same inputs give same budgets. About 50 ns a frame.
class BudgetGovernor
{
public:
    static constexpr std::uint32_t kSplitsLeast = 1;
    static constexpr std::uint32_t kScannedLeast = 32;
    static constexpr std::uint32_t kNodesLeast = 128;  ///< A base mesh's traversal needs some 40.
    static constexpr std::uint32_t kPlanesLeast = 128; ///< A slow hand's proxy needs some 60.
    static constexpr std::int64_t kStall = 4;

    /// `frame_budget` must be positive; no budget of `most` may be less than its floor. `walks` is
    /// how many traversals a frame makes at most, two for each pair of tool and object; `proxies`
    /// how many may spend a budget of planes each.
    BudgetGovernor(Duration frame_budget, const Budgets& most, std::uint32_t walks,
                   std::uint32_t proxies) noexcept;

    /// Of the next frame.
    [[nodiscard]] const Budgets& budgets() const noexcept { return budgets_; }

    /// Tells what the frame with budgets() took and did, and chooses the next ones.
    void observe(const FrameCost& cost) noexcept;

    /// Whether the set time is too short for even the least budgets, by what is known now.
    [[nodiscard]] bool is_at_floor() const noexcept { return is_at_floor_; }
    [[nodiscard]] const FrameCostModel& model() const noexcept { return model_; }

private:
    [[nodiscard]] bool is_stall(Duration frame) noexcept;
    void learn(const FrameCost& cost) noexcept;
    void choose() noexcept;

    double frame_budget_ns_;
    Budgets most_;
    double walks_;
    double proxies_;
    Budgets budgets_;
    FrameCostModel model_;
    FrameCostModel force_model_; ///< Its steps are planes.
    double frames_{0.0};
    double rest_ns_;        ///< Usual time of what is not governed.
    UpperLevel scatter_ns_; ///< How far frames exceed what was expected of them.
    UpperLevel steps_;      ///< Of the traversals.
    UpperLevel planes_;
    bool last_was_long_{false};
    bool is_at_floor_{false};
};

} // namespace tactus
