// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/object_pose.hpp"

#include <algorithm>
#include <string_view>

namespace tactus
{

/// Ranges of an object's material, from an option of hrtc, a scene file or a file of poses.
inline constexpr double kSoftest_n_per_m = 1.0;
inline constexpr double kStiffest_n_per_m = 3'000.0;    ///< Also the maximum of --stiffness.
inline constexpr double kSoftestTurn_nm_per_rad = 1e-3; ///< Minimum of --angular-stiffness.
inline constexpr double kStiffestTurn_nm_per_rad = 100.0;
inline constexpr double kRoughest = 3.0;
inline constexpr double kMostDamped_n_s_per_m = 20.0; ///< Maximum of damping and of viscosity.

/// Text of the ranges, for messages.
inline constexpr std::string_view kMaterialRanges =
    "1 to 3000 N/m, friction of 0 to 3, the dynamic one at most the static one, damping and "
    "viscosity of 0 to 20 N s/m, and a texture's height of at most 1/32 of its length of 0.0001 to "
    "1 m";

/// True if all values are in range. A material without a stiffness has that of the tool.
[[nodiscard]] constexpr bool is_in_range(const Material& material) noexcept
{
    const bool has_stiffness = material.stiffness_n_per_m != Material{}.stiffness_n_per_m;
    return material.stiffness_n_per_m >= kSoftest_n_per_m &&
           (!has_stiffness || material.stiffness_n_per_m <= kStiffest_n_per_m) &&
           material.dynamic_friction >= 0.0 &&
           material.dynamic_friction <= material.static_friction &&
           material.static_friction <= kRoughest && material.damping_n_s_per_m >= 0.0 &&
           material.damping_n_s_per_m <= kMostDamped_n_s_per_m &&
           material.viscosity_n_s_per_m >= 0.0 &&
           material.viscosity_n_s_per_m <= kMostDamped_n_s_per_m &&
           is_texture(material.texture_height_m, material.texture_length_m);
}

/// Nearest material in range to one that is_sound().
[[nodiscard]] constexpr Material within_ranges(Material material) noexcept
{
    const bool has_stiffness = material.stiffness_n_per_m != Material{}.stiffness_n_per_m;
    material.stiffness_n_per_m =
        has_stiffness ? std::clamp(material.stiffness_n_per_m, kSoftest_n_per_m, kStiffest_n_per_m)
                      : material.stiffness_n_per_m;
    material.static_friction = std::min(material.static_friction, kRoughest);
    material.dynamic_friction = std::min(material.dynamic_friction, kRoughest);
    material.damping_n_s_per_m = std::min(material.damping_n_s_per_m, kMostDamped_n_s_per_m);
    material.viscosity_n_s_per_m = std::min(material.viscosity_n_s_per_m, kMostDamped_n_s_per_m);
    return material;
}

} // namespace tactus
