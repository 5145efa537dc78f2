// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/sample_watch.hpp"

#include "rt_core/limits.hpp"
#include "rt_core/math/rotation.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

bool is_in_range(const Vec3& point) noexcept
{
    // Comparisons are false for NaN.
    return std::abs(point.x()) < kGoalRange_m && std::abs(point.y()) < kGoalRange_m &&
           std::abs(point.z()) < kGoalRange_m;
}

/// A device that doesn't know the time says 0 and is never late.
bool tells_time(const ToolState& sample) noexcept
{
    return sample.sample_time_ns != 0;
}

} // namespace

SampleWatch::Verdict SampleWatch::judge(const ToolState& sample, const ToolSpec& spec,
                                        const Vec3& goal_m, double elapsed_s) noexcept
{
    const Verdict verdict = take(sample, spec, goal_m, elapsed_s);
    fault_ = verdict.fault;
    return verdict;
}

SampleWatch::Verdict SampleWatch::take(const ToolState& sample, const ToolSpec& spec,
                                       const Vec3& goal_m, double elapsed_s) noexcept
{
    Verdict verdict;
    verdict.fault = find_fault(sample);
    const bool is_new = !tells_time(sample) || sample.sample_time_ns != time_ns_;
    blind_s_ += elapsed_s;
    if (verdict.fault != FrameFault::none || !is_new)
    {
        verdict.fault |=
            blind_s_ > kSampleHold_s && !is_new ? FrameFault::tool_stuck : FrameFault::none;
        return verdict;
    }
    verdict.is_taken = true;
    verdict.is_first = std::isinf(blind_s_);
    verdict.since_s = blind_s_;
    const double farthest = kJumpSpeeds * std::max(spec.speed_max_m_per_s, 1.0) * blind_s_;
    if (!verdict.is_first && (sample.position_m - goal_m).norm() > farthest)
    {
        has_lost_place_ = true;
        verdict.fault = FrameFault::tool_jumped;
    }
    time_ns_ = sample.sample_time_ns;
    blind_s_ = 0.0;
    return verdict;
}

FrameFault SampleWatch::find_fault(const ToolState& sample) const noexcept
{
    const bool is_late = tells_time(sample) && sample.sample_time_ns < time_ns_ &&
                         blind_s_ <= kSampleHold_s + kFadeTime_s;
    const bool is_usable = sample.valid && is_in_range(sample.position_m) &&
                           is_rotation(sample.rotation, kRotationTolerance) && !is_late;
    return is_usable ? FrameFault::none : FrameFault::tool_invalid;
}

void SampleWatch::look_for_return(const ToolOutput& output, const ToolSpec& spec,
                                  const Vec3& goal_m) noexcept
{
    const double spring_n = spec.stiffness_n_per_m * (output.proxy_m - goal_m).norm();
    has_lost_place_ = has_lost_place_ && spring_n > spec.force_max_n;
}

} // namespace tactus
