// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/records/material.hpp"
#include "transport/base/refusal.hpp"

#include <array>
#include <optional>
#include <string_view>

namespace tactus
{

/// One value of a material by the name that options, scene files and files of poses have for it.
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

/// What parse_material_keys() takes; for messages.
inline constexpr std::string_view kMaterialKeysForm =
    "any of stiffness=, static=, dynamic=, damping=, viscosity=, texture_height= and "
    "texture_length=, with commas between";

/// A material of the values that `value_of` has for the keys, a function of a name. What it has
/// none for is as where nothing is said: the tool's stiffness, and nothing else to be felt; a
/// dynamic friction that is left out is the static one. Ranges are not looked at.
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

/// KEY=VALUE[,KEY=VALUE...], each key once, with values within the ranges of is_in_range().
[[nodiscard]] Result<Material, Refusal> parse_material_keys(std::string_view text);

/// Likewise, or STIFFNESS[,STATIC[,DYNAMIC[,DAMPING]]].
[[nodiscard]] Result<Material, Refusal> parse_material(std::string_view text);

} // namespace tactus
