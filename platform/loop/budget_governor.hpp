// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"
#include "rt_core/records/work_budget.hpp"

#include <cstdint>

namespace tactus
{

/// Time and work of one frame.
struct FrameCost
{
    Duration frame;
    std::uint32_t work{0}; ///< Work of the frame, as WorkBudget::used() counts it.
};

/// Upper level of scattered values: rises by an eighth of the difference to a higher value, and
/// falls by 1/256 of the difference to a lower one. For values spread evenly over a range it
/// settles at about 85 % of the range.
class UpperLevel
{
public:
    explicit UpperLevel(double start) noexcept : level_(start) {}

    void observe(double value) noexcept
    {
        level_ += (value - level_) * (value > level_ ? 1.0 / 8.0 : 1.0 / 256.0);
    }
    [[nodiscard]] double level() const noexcept { return level_; }

private:
    double level_;
};

/// Chooses the work budget of each frame (Budgets::work) from the times of earlier frames, so that
/// a frame ends within `frame_budget` on machines slower than one instruction a nanosecond. Works
/// between frames without a clock: the budget is an input of the frame and can be recorded.
///
/// The governor fits the line time = rest + pace x work by least squares with decaying weights. The
/// means follow in about kWindowFrames frames, faster in the first ones; the pace changes only as
/// far as the work varied. `frame_budget` minus the rest and a reserve for scatter is left for
/// work. The budget falls to its new value at once and rises by a sixteenth of the difference a
/// frame, always within `least` and `most`. So every frame progresses, even if the time is too
/// short.
///
/// A single frame longer than kStall times `frame_budget` is attributed to the machine and ignored;
/// a second one in a row counts. Same inputs give same budgets. Haptic thread, about 20 ns a frame.
class BudgetGovernor
{
public:
    static constexpr double kWindowFrames = 128.0;
    static constexpr std::int64_t kStall = 4;
    /// Initial pace in nanoseconds a unit of work. The pace stays within a factor of kPaceRange of
    /// it, so that noise can't make work seem free.
    static constexpr double kFirstPace = 1.0;
    static constexpr double kPaceRange = 40.0;

    /// `frame_budget` must be positive, and `least` (Budgets::least_work()) no more than `most`.
    BudgetGovernor(Duration frame_budget, std::uint32_t least, std::uint32_t most) noexcept;

    /// Work budget of the next frame.
    [[nodiscard]] std::uint32_t work() const noexcept { return work_; }

    /// Learns from the frame with budget work() and chooses the next budget.
    void observe(const FrameCost& cost) noexcept;

    /// True if, by the present estimate, even the least work exceeds the frame budget.
    [[nodiscard]] bool is_at_floor() const noexcept { return is_at_floor_; }

private:
    [[nodiscard]] bool is_stall(Duration frame) noexcept;
    [[nodiscard]] double predict_ns(double work) const noexcept;
    void learn(double time_ns, double work) noexcept;
    void choose() noexcept;

    double frame_budget_ns_;
    std::uint32_t least_;
    std::uint32_t most_;
    std::uint32_t work_;
    double frames_{0.0};
    double mean_ns_{0.0};
    double mean_work_{0.0};
    double work_work_{0.0}; ///< Decayed variance of the work.
    double work_time_{0.0}; ///< Decayed covariance of work and time.
    double pace_ns_{kFirstPace};
    UpperLevel scatter_ns_{0.0}; ///< Excess of frame times over predict_ns(), in ns.
    bool last_was_long_{false};
    bool is_at_floor_{false};
};

} // namespace tactus
