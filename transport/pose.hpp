// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/limits.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

// Any thread: values, and functions of their arguments alone; no call waits or allocates.
namespace tactus
{

/// Where an object stands: world = translation + scale x rotation x point of the source mesh. The
/// same as hrtc's --place says, but for the rotation's form.
struct Pose
{
    std::array<double, 4> rotation{0.0, 0.0, 0.0, 1.0}; ///< Unit quaternion x, y, z, w.
    std::array<double, 3> translation_m{};
    double scale{1.0};

    bool operator==(const Pose&) const = default;
};

/// Why a pose isn't used.
enum class PoseRefusal : std::uint8_t
{
    not_newer,   ///< Its serial number isn't above that of the last one.
    not_finite,  ///< A number is none.
    rotation,    ///< The quaternion's length isn't within kPoseUnitTolerance of 1.
    translation, ///< Beyond kPoseReachMax_m.
    scale,       ///< Outside kPoseScaleMin to kPoseScaleMax.
};

inline constexpr std::size_t kPoseRefusals = 5;
/// In the order of PoseRefusal.
inline constexpr std::array<const char*, kPoseRefusals> kPoseRefusalNames{
    "not_newer", "not_finite", "rotation", "translation", "scale"};

/// The same pose with a rotation of length 1, or what is wrong with its numbers.
[[nodiscard]] Result<Pose, PoseRefusal> checked_pose(const Pose& pose) noexcept;

} // namespace tactus
