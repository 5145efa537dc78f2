// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/object_pose.hpp"

#include <string_view>

namespace tactus
{

/// What an object's material may be, whoever says so: an option of hrtc or a scene file.
inline constexpr double kSoftest_n_per_m = 1.0;
inline constexpr double kStiffest_n_per_m = 3'000.0;    ///< Of --stiffness, too.
inline constexpr double kSoftestTurn_nm_per_rad = 1e-3; ///< Of --angular-stiffness.
inline constexpr double kStiffestTurn_nm_per_rad = 100.0;
inline constexpr double kRoughest = 3.0;
inline constexpr double kMostDamped_n_s_per_m = 20.0;

/// The same in words, for messages.
inline constexpr std::string_view kMaterialRanges =
    "1 to 3000 N/m, friction of 0 to 3, the dynamic one at most the static one, and 0 to 20 N s/m";

/// A material that names no stiffness has that of the tool.
[[nodiscard]] constexpr bool is_in_range(const Material& material) noexcept
{
    const bool has_stiffness = material.stiffness_n_per_m != Material{}.stiffness_n_per_m;
    return material.stiffness_n_per_m >= kSoftest_n_per_m &&
           (!has_stiffness || material.stiffness_n_per_m <= kStiffest_n_per_m) &&
           material.dynamic_friction >= 0.0 &&
           material.dynamic_friction <= material.static_friction &&
           material.static_friction <= kRoughest && material.damping_n_s_per_m >= 0.0 &&
           material.damping_n_s_per_m <= kMostDamped_n_s_per_m;
}

} // namespace tactus
