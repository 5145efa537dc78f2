// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/device_choice.hpp"
#include "rt_core/limits.hpp"
#include "transport/base/number_form.hpp"

#include <Eigen/Geometry>

#include <numbers>
#include <string_view>
#include <vector>

namespace tactus::hrtc
{

namespace
{

/// Rotation matrix, orthonormal to 2e-15. Computed once for each object, as for a server's poses.
/// No frame composes two rotations, so nothing can drift.
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

constexpr double kTurnMax_deg = 360.0;
constexpr NumberRange kPlaceAlong{-kPoseReachMax_m, kPoseReachMax_m, "m"};
constexpr NumberRange kTurnAbout{-kTurnMax_deg, kTurnMax_deg, "degrees"};
constexpr NumberRange kPlacementRanges[] = {kPlaceAlong,
                                            kPlaceAlong,
                                            kPlaceAlong,
                                            kTurnAbout,
                                            kTurnAbout,
                                            kTurnAbout,
                                            {kPoseScaleMin, kPoseScaleMax}};
constexpr NumberForm kPlacementForm{"X,Y,Z[,RX,RY,RZ[,SCALE]]", kPlacementRanges};

} // namespace

Result<Similarity, Refusal> parse_placement(std::string_view text)
{
    const auto numbers = read_numbers(text, kPlacementForm);
    if (!numbers)
    {
        return numbers.error();
    }
    const std::vector<double>& n = numbers.value();
    const Vec3 rotation_deg = n.size() >= 6 ? Vec3(n[3], n[4], n[5]) : Vec3(0.0, 0.0, 0.0);
    if (rotation_deg.norm() > kTurnMax_deg)
    {
        return not_of_form(text, kPlacementForm.text, "RX,RY,RZ is longer than 360 degrees");
    }
    return Similarity{rotation_of(rotation_deg), Vec3(n[0], n[1], n[2]),
                      n.size() == 7 ? n[6] : 1.0};
}

} // namespace tactus::hrtc
