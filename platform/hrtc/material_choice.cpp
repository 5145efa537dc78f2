// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/material_choice.hpp"

#include "host_tools/scene/material_ranges.hpp"
#include "platform/hrtc/numbers.hpp"

#include <cstddef>
#include <vector>

namespace tactus::hrtc
{

std::optional<Material> parse_material(std::string_view text)
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
    return is_in_range(material) ? std::optional(material) : std::nullopt;
}

} // namespace tactus::hrtc
