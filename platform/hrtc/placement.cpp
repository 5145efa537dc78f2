// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/placement.hpp"

#include <Eigen/Geometry>

#include <numbers>

namespace tactus::hrtc
{

Mat3 rotation_of(const Placement& placement)
{
    const double angle_deg = placement.rotation_deg.norm();
    if (angle_deg == 0.0)
    {
        return Mat3::Identity();
    }
    const double angle_rad = angle_deg * std::numbers::pi / 180.0;
    return Eigen::AngleAxisd(angle_rad, placement.rotation_deg / angle_deg).toRotationMatrix();
}

} // namespace tactus::hrtc
