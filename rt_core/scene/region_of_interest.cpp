// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/scene/region_of_interest.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>

namespace tactus
{

namespace
{

/// Length of an approach, as a share of the reach, up to which its end is not refined separately.
constexpr double kLeastApproach = 0.1;

} // namespace

void RegionOfInterest::update(const ToolSpec& tool, const ToolPlacement& placement,
                              const ObjectPose& pose) noexcept
{
    TACTUS_ASSERT(placement.reach_m >= 0.0);
    TACTUS_ASSERT(pose.scale > 0.0);
    core_ = PlacedCore(tool.core, in_frame(pose, placement.place));
    cover_ = core_.cover(tool.radius_m / pose.scale);
    reach_m_ = placement.reach_m / pose.scale;
    approach_m_ = (pose.rotation.transpose() * placement.approach_m) / pose.scale;
    const double awake_m = kKeepFactor * reach_m_ + approach_m_.norm();
    motion_m_ = has_known_ ? core_.motion_since(known_core_) : 0.0;
    is_asleep_ = has_bounds() && known_.lower_m - motion_m_ > awake_m;
}

void RegionOfInterest::remember(const DistanceAnswer& answer) noexcept
{
    TACTUS_ASSERT(answer.lower_m >= 0.0);
    TACTUS_ASSERT(answer.lower_m <= answer.upper_m);
    known_ = answer;
    known_core_ = core_;
    motion_m_ = 0.0;
    has_known_ = true;
    is_outdated_ = false;
}

bool RegionOfInterest::looks_ahead() const noexcept
{
    return !is_asleep_ && approach_m_.norm() > kLeastApproach * reach_m_;
}

bool RegionOfInterest::is_near_surface() const noexcept
{
    return has_known_ && known_.upper_m + motion_m_ <= kKeepFactor * reach_m_;
}

DistanceAnswer RegionOfInterest::from_motion() const noexcept
{
    TACTUS_ASSERT(has_known_);
    DistanceAnswer answer;
    answer.lower_m = std::max(0.0, known_.lower_m - motion_m_);
    answer.upper_m = known_.upper_m + motion_m_;
    answer.kind = answer.lower_m > reach_m_ ? AnswerKind::separated : AnswerKind::bounded;
    answer.tool_point_m = core_.center();
    return answer;
}

} // namespace tactus
