// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/sample_watch.hpp"

#include "rt_core/force/angular_stiffness.hpp"
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
    // Comparisons with NaN are false.
    return std::abs(point.x()) < kGoalRange_m && std::abs(point.y()) < kGoalRange_m &&
           std::abs(point.z()) < kGoalRange_m;
}

/// False for a device without a clock: its time is 0, and no sample is late.
bool tells_time(const ToolState& sample) noexcept
{
    return sample.sample_time_ns != 0;
}

bool turns(const ToolSpec& spec) noexcept
{
    return !std::holds_alternative<PointCore>(spec.core);
}

/// Angle between two rotations in rad. Both must be rotations to kRotationTolerance.
double angle_between(const Mat3& from, const Mat3& to) noexcept
{
    return from == to ? 0.0 : rotation_vector(orthonormalised(to * from.transpose())).norm();
}

} // namespace

SampleWatch::Verdict SampleWatch::judge(const ToolState& sample, const ToolSpec& spec,
                                        const ProxyGoal& goal, double elapsed_s) noexcept
{
    const Verdict verdict = take(sample, spec, goal, elapsed_s);
    fault_ = verdict.fault;
    return verdict;
}

SampleWatch::Verdict SampleWatch::take(const ToolState& sample, const ToolSpec& spec,
                                       const ProxyGoal& goal, double elapsed_s) noexcept
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
    if (!verdict.is_first && is_jump(sample, spec, goal))
    {
        has_lost_place_ = true;
        verdict.fault = FrameFault::tool_jumped;
    }
    time_ns_ = sample.sample_time_ns;
    blind_s_ = 0.0;
    return verdict;
}

bool SampleWatch::is_jump(const ToolState& sample, const ToolSpec& spec,
                          const ProxyGoal& goal) const noexcept
{
    const double farthest_m = kJumpSpeeds * std::max(spec.speed_max_m_per_s, 1.0) * blind_s_;
    return (sample.position_m - goal.position_m).norm() > farthest_m ||
           (turns(spec) &&
            angle_between(goal.rotation, sample.rotation) > kJumpRotation_rad_per_s * blind_s_);
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
                                  const ProxyGoal& goal) noexcept
{
    if (!has_lost_place_)
    {
        return;
    }
    const double spring_n = spec.stiffness_n_per_m * (output.proxy_m - goal.position_m).norm();
    const double spring_nm = turns(spec) && output.proxy_rotation.allFinite()
                                 ? angular_stiffness_nm_per_rad(spec) *
                                       angle_between(goal.rotation, output.proxy_rotation)
                                 : 0.0;
    has_lost_place_ =
        spring_n > spec.force_max_n || (spec.torque_max_nm > 0.0 && spring_nm > spec.torque_max_nm);
}

} // namespace tactus
