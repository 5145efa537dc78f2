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

/// Key of one value of a material, the same in options, scene files and files of poses.
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

/// Form that parse_material_keys() takes; for messages.
inline constexpr std::string_view kMaterialKeysForm =
    "any of stiffness=, static=, dynamic=, damping=, viscosity=, texture_height= and "
    "texture_length=, with commas between";

/// Builds a material from `value_of`, a function from a key to an optional value. Defaults of
/// missing keys: the tool's stiffness, the static friction for the dynamic one, and 0 for the rest.
/// Ranges are not checked.
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

/// Reads KEY=VALUE[,KEY=VALUE...], each key once, with values within the ranges of is_in_range().
[[nodiscard]] Result<Material, Refusal> parse_material_keys(std::string_view text);

/// Reads the same form, or STIFFNESS[,STATIC[,DYNAMIC[,DAMPING]]].
[[nodiscard]] Result<Material, Refusal> parse_material(std::string_view text);

} // namespace tactus
