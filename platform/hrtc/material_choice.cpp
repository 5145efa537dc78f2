// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/material_choice.hpp"

#include "host_tools/scene/material_ranges.hpp"
#include "platform/hrtc/numbers.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace tactus::hrtc
{

namespace
{

struct Key
{
    std::string_view name;
    double Material::*value;
};

constexpr std::array<Key, 4> kKeys{{{"stiffness", &Material::stiffness_n_per_m},
                                    {"static", &Material::static_friction},
                                    {"dynamic", &Material::dynamic_friction},
                                    {"damping", &Material::damping_n_s_per_m}}};

/// STIFFNESS[,STATIC[,DYNAMIC[,DAMPING]]].
std::optional<Material> parse_in_order(std::string_view text)
{
    const std::optional<std::vector<double>> numbers = parse_numbers(text);
    if (!numbers || numbers->size() > 4)
    {
        return std::nullopt;
    }
    const auto number = [&numbers](std::size_t i, double otherwise)
    { return i < numbers->size() ? (*numbers)[i] : otherwise; };
    Material material;
    material.stiffness_n_per_m = number(0, 0.0);
    material.static_friction = number(1, 0.0);
    material.dynamic_friction = number(2, material.static_friction);
    material.damping_n_s_per_m = number(3, 0.0);
    return material;
}

/// KEY=VALUE[,KEY=VALUE...], each key once.
std::optional<Material> parse_by_name(std::string_view text)
{
    std::array<std::optional<double>, kKeys.size()> said;
    while (true)
    {
        const std::size_t comma = text.find(',');
        const std::string_view pair = text.substr(0, comma);
        const std::size_t equals = pair.find('=');
        const auto key = std::ranges::find(kKeys, pair.substr(0, equals), &Key::name);
        if (equals == std::string_view::npos || key == kKeys.end())
        {
            return std::nullopt;
        }
        const auto value = parse_numbers(pair.substr(equals + 1));
        std::optional<double>& place = said[static_cast<std::size_t>(key - kKeys.begin())];
        if (!value || value->size() != 1 || place)
        {
            return std::nullopt;
        }
        place = value->front();
        if (comma == std::string_view::npos)
        {
            break;
        }
        text.remove_prefix(comma + 1);
    }
    Material material;
    for (std::size_t i = 0; i < kKeys.size(); ++i)
    {
        material.*kKeys[i].value = said[i].value_or(material.*kKeys[i].value);
    }
    material.dynamic_friction = said[2].value_or(material.static_friction);
    // What is said must be a stiffness; infinite is the one of none.
    const bool is_stiff = !said[0] || *said[0] <= kStiffest_n_per_m;
    return is_stiff ? std::optional(material) : std::nullopt;
}

} // namespace

std::optional<Material> parse_material(std::string_view text)
{
    const std::optional<Material> material =
        text.find('=') == std::string_view::npos ? parse_in_order(text) : parse_by_name(text);
    return material && is_in_range(*material) ? material : std::nullopt;
}

} // namespace tactus::hrtc
