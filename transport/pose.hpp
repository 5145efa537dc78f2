// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/limits.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

// Any thread: no call waits or allocates, and results depend on the arguments alone.
namespace tactus
{

/// Pose of an object: world = translation + scale x rotation x point of the source mesh. hrtc's
/// --place option has the same values, except for its form of the rotation.
struct Pose
{
    std::array<double, 4> rotation{0.0, 0.0, 0.0, 1.0}; ///< Unit quaternion x, y, z, w.
    std::array<double, 3> translation_m{};
    double scale{1.0};

    bool operator==(const Pose&) const = default;
};

/// Reason why a pose is refused.
enum class PoseRefusal : std::uint8_t
{
    not_newer,   ///< Serial number not above that of the last pose.
    not_finite,  ///< Number that is not finite.
    rotation,    ///< Quaternion whose length is not within kPoseUnitTolerance of 1.
    translation, ///< Translation beyond kPoseReachMax_m.
    scale,       ///< Scale outside kPoseScaleMin to kPoseScaleMax.
};

inline constexpr std::size_t kPoseRefusals = 5;
/// Names in the order of PoseRefusal.
inline constexpr std::array<const char*, kPoseRefusals> kPoseRefusalNames{
    "not_newer", "not_finite", "rotation", "translation", "scale"};

/// Pose with its rotation scaled to length 1, or the reason why the pose is refused. `translation`
/// is the reason only if all else is in range.
[[nodiscard]] Result<Pose, PoseRefusal> checked_pose(const Pose& pose) noexcept;

} // namespace tactus
