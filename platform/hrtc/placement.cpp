// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/placement.hpp"

#include "platform/base/numbers.hpp"
#include "rt_core/limits.hpp"

#include <Eigen/Geometry>

#include <numbers>
#include <vector>

namespace tactus::hrtc
{

namespace
{

/// Orthonormal to 2e-15. Made once for each object, as a host's poses are: no frame
/// ever composes two rotations, so there is nothing to drift.
Mat3 rotation_of(const Vec3& vector_deg)
{
    const double angle_deg = vector_deg.norm();
    if (angle_deg == 0.0)
    {
        return Mat3::Identity();
    }
    const double angle_rad = angle_deg * std::numbers::pi / 180.0;
    return Eigen::AngleAxisd(angle_rad, vector_deg / angle_deg).toRotationMatrix();
}

} // namespace

std::optional<Similarity> parse_placement(std::string_view text)
{
    const std::optional<std::vector<double>> numbers = parse_numbers(text);
    if (!numbers || (numbers->size() != 3 && numbers->size() != 6 && numbers->size() != 7))
    {
        return std::nullopt;
    }
    const std::vector<double>& n = *numbers;
    const Vec3 translation_m(n[0], n[1], n[2]);
    const Vec3 rotation_deg = n.size() >= 6 ? Vec3(n[3], n[4], n[5]) : Vec3(0.0, 0.0, 0.0);
    const double scale = n.size() == 7 ? n[6] : 1.0;
    const bool in_range = translation_m.cwiseAbs().maxCoeff() <= kPoseReachMax_m &&
                          rotation_deg.norm() <= 360.0 && scale >= kPoseScaleMin &&
                          scale <= kPoseScaleMax;
    return in_range ? std::optional<Similarity>({rotation_of(rotation_deg), translation_m, scale})
                    : std::nullopt;
}

} // namespace tactus::hrtc
