// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/frame_cost_model.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// Added to the variances: work that varies by less than 4 edits or 20 steps says little.
constexpr double kEditsDoubt = 4.0 * 4.0;
constexpr double kStepsDoubt = 20.0 * 20.0;
/// Share of the way that the slopes go in one frame, once the first frames are over.
constexpr double kSlopeGain = 1.0 / 16.0;

double in_range(double slope, double first) noexcept
{
    return std::clamp(slope, first / FrameCostModel::kSlopeRange,
                      first * FrameCostModel::kSlopeRange);
}

} // namespace

void FrameCostModel::observe(double time_ns, double edits, double steps) noexcept
{
    frames_ = std::min(frames_ + 1.0, kWindowFrames);
    follow_means(time_ns, edits, steps, 1.0 / frames_);
    follow_slopes(std::max(1.0 / frames_, kSlopeGain));
}

void FrameCostModel::follow_means(double time_ns, double edits, double steps,
                                  double weight) noexcept
{
    const double time_off = time_ns - time_ns_;
    const double edits_off = edits - edits_;
    const double steps_off = steps - steps_;
    time_ns_ += weight * time_off;
    edits_ += weight * edits_off;
    steps_ += weight * steps_off;
    const auto follow = [weight](double& covariance, double product)
    { covariance = (1.0 - weight) * (covariance + weight * product); };
    follow(edits_edits_, edits_off * edits_off);
    follow(edits_steps_, edits_off * steps_off);
    follow(steps_steps_, steps_off * steps_off);
    follow(edits_time_, edits_off * time_off);
    follow(steps_time_, steps_off * time_off);
}

/// One step towards the slopes that leave no covariance between work and what they don't explain.
void FrameCostModel::follow_slopes(double gain) noexcept
{
    const double edits_left =
        edits_time_ - edits_edits_ * per_edit_ns_ - edits_steps_ * per_step_ns_;
    const double steps_left =
        steps_time_ - edits_steps_ * per_edit_ns_ - steps_steps_ * per_step_ns_;
    const double a = edits_edits_ + kEditsDoubt;
    const double b = edits_steps_;
    const double d = steps_steps_ + kStepsDoubt;
    const double determinant = a * d - b * b; // Positive: |b| is at most the variances' mean.
    per_edit_ns_ = in_range(per_edit_ns_ + gain * (d * edits_left - b * steps_left) / determinant,
                            kFirstPerEdit_ns);
    per_step_ns_ = in_range(per_step_ns_ + gain * (a * steps_left - b * edits_left) / determinant,
                            kFirstPerStep_ns);
}

} // namespace tactus
