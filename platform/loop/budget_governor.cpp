// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/budget_governor.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// Largest share of the frame budget that the reserve for scatter takes.
constexpr double kScatterShare = 0.5;
/// Added to the variance of work in the step of the pace: work that varies by less than 2,000 units
/// hardly moves the pace.
constexpr double kDoubt = 2'000.0 * 2'000.0;
/// Variance of work below which the pace settles nearer to kFirstPace than to the measured one.
constexpr double kPrior = 1'000.0 * 1'000.0;
/// Least share of the difference by which the pace follows in a frame; the first frames take more.
constexpr double kPaceGain = 1.0 / 16.0;

} // namespace

BudgetGovernor::BudgetGovernor(Duration frame_budget, std::uint32_t least,
                               std::uint32_t most) noexcept
    : frame_budget_ns_(static_cast<double>(frame_budget.ns))
    , least_(least)
    , most_(most)
    , work_(most)
{
    TACTUS_ASSERT(frame_budget > Duration{});
    TACTUS_ASSERT(least <= most);
    choose();
}

void BudgetGovernor::observe(const FrameCost& cost) noexcept
{
    if (!is_stall(cost.frame))
    {
        learn(static_cast<double>(cost.frame.ns), static_cast<double>(cost.work));
        choose();
    }
}

bool BudgetGovernor::is_stall(Duration frame) noexcept
{
    const bool is_long =
        static_cast<double>(frame.ns) > static_cast<double>(kStall) * frame_budget_ns_;
    const bool is_first = is_long && !last_was_long_;
    last_was_long_ = is_long;
    return is_first;
}

double BudgetGovernor::predict_ns(double work) const noexcept
{
    return std::max(mean_ns_ + pace_ns_ * (work - mean_work_), 0.0);
}

void BudgetGovernor::learn(double time_ns, double work) noexcept
{
    if (frames_ > 0.0) // The first frame has no prediction.
    {
        scatter_ns_.observe(
            std::clamp(time_ns - predict_ns(work), 0.0, kScatterShare * frame_budget_ns_));
    }
    frames_ = std::min(frames_ + 1.0, kWindowFrames);
    const double weight = 1.0 / frames_;
    const double time_off = time_ns - mean_ns_;
    const double work_off = work - mean_work_;
    mean_ns_ += weight * time_off;
    mean_work_ += weight * work_off;
    work_work_ = (1.0 - weight) * (work_work_ + weight * work_off * work_off);
    work_time_ = (1.0 - weight) * (work_time_ + weight * work_off * time_off);
    // The pace moves towards the value that leaves no covariance between work and unexplained time.
    // Without variation it tends to kFirstPace, so that noise does not accumulate in it.
    const double left = work_time_ - work_work_ * pace_ns_ + kPrior * (kFirstPace - pace_ns_);
    pace_ns_ = std::clamp(pace_ns_ + std::max(weight, kPaceGain) * left / (work_work_ + kDoubt),
                          kFirstPace / kPaceRange, kFirstPace * kPaceRange);
}

void BudgetGovernor::choose() noexcept
{
    const double room_ns = frame_budget_ns_ - predict_ns(0.0) - scatter_ns_.level();
    const double fits = room_ns / pace_ns_;
    const auto wanted = static_cast<std::uint32_t>(
        std::clamp(fits, static_cast<double>(least_), static_cast<double>(most_)));
    is_at_floor_ = fits < static_cast<double>(least_);
    work_ = wanted <= work_ ? wanted : work_ + (wanted - work_ + 15) / 16;
}

} // namespace tactus
