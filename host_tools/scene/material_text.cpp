// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/material_text.hpp"

#include "host_tools/scene/material_ranges.hpp"
#include "platform/base/numbers.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace tactus
{

namespace
{

/// Numbers that are no stiffness, or out of range.
std::optional<Material> checked(const Material& material)
{
    return is_in_range(material) ? std::optional(material) : std::nullopt;
}

std::optional<Material> parse_in_order(std::string_view text)
{
    const std::optional<std::vector<double>> numbers = parse_numbers(text);
    if (!numbers || numbers->size() > 4)
    {
        return std::nullopt;
    }
    return checked(material_of(
        [&numbers](std::string_view name)
        {
            const auto key = std::ranges::find(kMaterialKeys, name, &MaterialKey::name);
            const auto place = static_cast<std::size_t>(key - kMaterialKeys.begin());
            return place < numbers->size() ? std::optional((*numbers)[place]) : std::nullopt;
        }));
}

} // namespace

std::optional<Material> parse_material_keys(std::string_view text)
{
    std::array<std::optional<double>, kMaterialKeys.size()> said;
    for (bool is_last = false; !is_last;)
    {
        const std::size_t comma = text.find(',');
        const std::string_view pair = text.substr(0, comma);
        const std::size_t equals = pair.find('=');
        const auto key =
            std::ranges::find(kMaterialKeys, pair.substr(0, equals), &MaterialKey::name);
        if (equals == std::string_view::npos || key == kMaterialKeys.end())
        {
            return std::nullopt;
        }
        std::optional<double>& place = said[static_cast<std::size_t>(key - kMaterialKeys.begin())];
        const auto value = parse_number(pair.substr(equals + 1));
        if (!value || place)
        {
            return std::nullopt;
        }
        place = value;
        is_last = comma == std::string_view::npos;
        text.remove_prefix(is_last ? text.size() : comma + 1);
    }
    return checked(material_of(
        [&said](std::string_view name)
        {
            const auto key = std::ranges::find(kMaterialKeys, name, &MaterialKey::name);
            return said[static_cast<std::size_t>(key - kMaterialKeys.begin())];
        }));
}

std::optional<Material> parse_material(std::string_view text)
{
    return text.find('=') == std::string_view::npos ? parse_in_order(text)
                                                    : parse_material_keys(text);
}

} // namespace tactus
