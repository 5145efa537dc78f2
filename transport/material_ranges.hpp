// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/object_pose.hpp"

#include <algorithm>
#include <string_view>

namespace tactus
{

/// Ranges of a material's values in options of hrtc, scene files and pose files.
inline constexpr double kSoftest_n_per_m = 1.0;
inline constexpr double kStiffest_n_per_m = 3'000.0; ///< Also the maximum of --stiffness.
inline constexpr double kSoftest_nm_per_rad = 1e-3;  ///< Minimum of --angular-stiffness.
inline constexpr double kStiffest_nm_per_rad = 100.0;
inline constexpr double kRoughest = 3.0;
inline constexpr double kMostDamped_n_s_per_m = 20.0; ///< Maximum of damping and of viscosity.

/// Text of the ranges, for messages.
inline constexpr std::string_view kMaterialRanges =
    "a stiffness of 1 to 3000 N/m, friction of 0 to 3, the dynamic friction at most the static "
    "friction, damping and viscosity of 0 to 20 N s/m, and a texture height of at most 1/32 of the "
    "texture length of 0.0001 to 1 m";

/// True if all values are in range. Material{}'s stiffness, which means that of the tool, is in
/// range.
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

/// Clamps stiffness, friction, damping and viscosity of a material, which must pass is_sound(),
/// into their ranges.
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
