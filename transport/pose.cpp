// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/pose.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

Result<Pose, PoseRefusal> checked_pose(const Pose& pose) noexcept
{
    const auto is_finite = [](double value) { return std::isfinite(value); };
    if (!std::ranges::all_of(pose.rotation, is_finite) ||
        !std::ranges::all_of(pose.translation_m, is_finite) || !is_finite(pose.scale))
    {
        return PoseRefusal::not_finite;
    }
    const auto& q = pose.rotation;
    const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
    if (std::abs(length - 1.0) > kPoseUnitTolerance)
    {
        return PoseRefusal::rotation;
    }
    if (pose.scale < kPoseScaleMin || pose.scale > kPoseScaleMax)
    {
        return PoseRefusal::scale;
    }
    if (std::ranges::any_of(pose.translation_m,
                            [](double at_m) { return std::abs(at_m) > kPoseReachMax_m; }))
    {
        return PoseRefusal::translation;
    }
    Pose unit = pose;
    std::ranges::transform(q, unit.rotation.begin(), [&](double part) { return part / length; });
    return unit;
}

} // namespace tactus
