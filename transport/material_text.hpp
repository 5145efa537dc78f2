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
