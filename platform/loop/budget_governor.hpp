// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/time.hpp"
#include "rt_core/records/work_budget.hpp"

#include <cstdint>

namespace tactus
{

/// What one frame took and did.
struct FrameCost
{
    Duration frame;
    std::uint32_t work{0}; ///< WorkBudget::used().
};

/// Follows the upper end of values that scatter: up by an eighth of the way at once, down by one
/// part in 256 a frame. Where values scatter evenly it comes to rest near the highest of 50.
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

/// Chooses how much work each frame may do (Budgets::work) from what the frames before it took, so
/// that a frame fits into a set time on a machine that is slower than an instruction a nanosecond.
/// It works between frames and has no clock: its choice is an input of the frame like any other,
/// and can be recorded.
///
/// It learns a line by decayed least squares, time = rest + pace x work. The means follow in about
/// kWindowFrames frames, and in the first ones as fast as they can; the pace moves only as far as
/// the work varied. What is left of the time after the rest and a reserve for scatter is given to
/// work. The budget falls to its new value at once and rises by a sixteenth of the way a frame,
/// never above `most` and never below `least`, so a frame gets on even where the time
/// is too short.
///
/// A single frame of more than kStall times the set time is taken for the machine's and teaches
/// nothing; a second one in a row counts. Same inputs give same budgets. Haptic thread, about 20 ns
/// a frame.
class BudgetGovernor
{
public:
    static constexpr double kWindowFrames = 128.0;
    static constexpr std::int64_t kStall = 4;
    /// Nanoseconds for a unit of work before anything is known, and how far from it the pace may
    /// go: noise can't make work free.
    static constexpr double kFirstPace = 1.0;
    static constexpr double kPaceRange = 40.0;

    /// `frame_budget` must be positive, and `least` no more than `most`: Budgets::least_work().
    BudgetGovernor(Duration frame_budget, std::uint32_t least, std::uint32_t most) noexcept;

    /// Of the next frame.
    [[nodiscard]] std::uint32_t work() const noexcept { return work_; }

    /// Tells what the frame with work() took and did, and chooses the next one's.
    void observe(const FrameCost& cost) noexcept;

    /// Whether the set time is too short for even the least work, by what is known now.
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
    double work_work_{0.0}; ///< Decayed variance,
    double work_time_{0.0}; ///< and covariance.
    double pace_ns_{kFirstPace};
    UpperLevel scatter_ns_{0.0}; ///< How far frames exceed what was expected of them.
    bool last_was_long_{false};
    bool is_at_floor_{false};
};

} // namespace tactus
