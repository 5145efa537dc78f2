// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/records/material.hpp"
#include "rt_core/records/object_pose.hpp"
#include "transport/base/refusal.hpp"

#include <algorithm>
#include <array>
#include <optional>
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

/// Key of one value of a material, the same in options, scene files and pose files.
struct MaterialKey
{
    std::string_view name;
    double Material::*value;
};
inline constexpr std::array<MaterialKey, 7> kMaterialKeys{{
    {"stiffness", &Material::stiffness_n_per_m},
    {"static", &Material::static_friction},
    {"dynamic", &Material::dynamic_friction},
    {"damping", &Material::damping_n_s_per_m},
    {"viscosity", &Material::viscosity_n_s_per_m},
    {"texture_height", &Material::texture_height_m},
    {"texture_length", &Material::texture_length_m},
}};

/// Form of parse_material_keys()'s text, for messages.
inline constexpr std::string_view kMaterialKeysForm =
    "any of stiffness=, static=, dynamic=, damping=, viscosity=, texture_height= and "
    "texture_length=, with commas between";

/// Builds a material from `value_of`, which maps a key to an optional value. A missing dynamic
/// friction equals the static one; other missing values stay those of Material{}. Ranges are not
/// checked.
template <typename ValueOf>
[[nodiscard]] Material material_of(const ValueOf& value_of)
{
    Material material;
    for (const MaterialKey& key : kMaterialKeys)
    {
        const std::optional<double> value = value_of(key.name);
        const bool is_dynamic = key.value == &Material::dynamic_friction;
        material.*key.value =
            value.value_or(is_dynamic ? material.static_friction : material.*key.value);
    }
    return material;
}

/// Reads KEY=VALUE[,KEY=VALUE...], each key once. Values out of range are refused (is_in_range()).
[[nodiscard]] Result<Material, Refusal> parse_material_keys(std::string_view text);

/// Reads either the form of parse_material_keys() or STIFFNESS[,STATIC[,DYNAMIC[,DAMPING]]].
[[nodiscard]] Result<Material, Refusal> parse_material(std::string_view text);

} // namespace tactus
