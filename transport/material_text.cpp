// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/material_text.hpp"

#include "transport/base/number_form.hpp"
#include "transport/base/printable.hpp"
#include "transport/base/suggestions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace tactus
{

namespace
{

constexpr NumberRange kFriction{0.0, kRoughest};
constexpr NumberRange kDamping{0.0, kMostDamped_n_s_per_m, "N s/m"};
/// Ranges in the order of kMaterialKeys.
constexpr std::array<NumberRange, kMaterialKeys.size()> kValueRanges{{
    {kSoftest_n_per_m, kStiffest_n_per_m, "N/m"},
    kFriction,
    kFriction,
    kDamping,
    kDamping,
    {0.0, kTextureSteepest* kTextureLengthMax_m, "m"},
    {0.0, kTextureLengthMax_m, "m"},
}};
constexpr NumberForm kInOrder{"STIFFNESS[,STATIC[,DYNAMIC[,DAMPING]]]", {kValueRanges.data(), 4}};
constexpr std::string_view kByName = "KEY=VALUE[,KEY=VALUE...]";

std::size_t place_of(std::string_view key)
{
    return static_cast<std::size_t>(std::ranges::find(kMaterialKeys, key, &MaterialKey::name) -
                                    kMaterialKeys.begin());
}

/// Fault of values that are valid alone but not together; empty for a valid material.
std::string fault_of(const Material& material)
{
    if (material.dynamic_friction > material.static_friction)
    {
        return fmt::format("the dynamic friction, {}, is above the static friction, {}",
                           material.dynamic_friction, material.static_friction);
    }
    return is_in_range(material) ? ""
                                 : "texture_height must be at most 1/32 of texture_length, and "
                                   "texture_length 0.0001 to 1 m";
}

Result<Material, Refusal> parse_in_order(std::string_view text)
{
    const auto numbers = read_numbers(text, kInOrder);
    if (!numbers)
    {
        return numbers.error();
    }
    std::vector<double> n = numbers.value();
    const Material material = material_of(
        [&n](std::string_view name)
        {
            const std::size_t place = place_of(name);
            return place < n.size() ? std::optional(n[place]) : std::nullopt;
        });
    if (const std::string fault = fault_of(material); !fault.empty())
    {
        // With four values, friction in the wrong order is the only possible fault.
        std::swap(n[1], n[2]);
        return not_of_form(text, kInOrder.text, fault, fmt::format("{}", fmt::join(n, ",")));
    }
    return material;
}

/// Refusal of `text` because `pair`, a part of it, does not begin with a known key and '='.
Refusal no_key(std::string_view text, std::string_view pair)
{
    const std::string_view key = pair.substr(0, pair.find('='));
    std::vector<std::string_view> names;
    for (const MaterialKey& each : kMaterialKeys)
    {
        names.push_back(each.name);
    }
    if (const std::string nearest = nearest_word(key, names);
        key.size() < pair.size() && !nearest.empty())
    {
        std::string meant(text);
        meant.replace(static_cast<std::size_t>(pair.data() - text.data()), key.size(), nearest);
        return not_of_form(text, kByName, fmt::format("no key is called '{}'", printable(key)),
                           parse_material_keys(meant) ? meant : nearest + "=");
    }
    return not_of_form(
        text, kByName,
        fmt::format("'{}' has none of the keys {}", printable(pair), fmt::join(names, ", ")));
}

} // namespace

Result<Material, Refusal> parse_material_keys(std::string_view text)
{
    std::array<std::optional<double>, kMaterialKeys.size()> given;
    for (std::size_t at = 0; at <= text.size();)
    {
        const std::size_t comma = std::min(text.find(',', at), text.size());
        const std::string_view pair = text.substr(at, comma - at);
        const std::size_t equals = std::min(pair.find('='), pair.size());
        const std::string_view key = pair.substr(0, equals);
        const std::size_t place = place_of(key);
        if (equals == pair.size() || place == kMaterialKeys.size())
        {
            return no_key(text, pair);
        }
        const std::string_view value = pair.substr(equals + 1);
        const std::string fault = given[place] ? fmt::format("{} is given twice", key)
                                               : fault_of_number(key, value, kValueRanges[place]);
        if (!fault.empty())
        {
            return not_of_form(text, kByName, fault);
        }
        given[place] = parse_number(value);
        at = comma + 1;
    }
    const Material material =
        material_of([&given](std::string_view name) { return given[place_of(name)]; });
    const std::string fault = fault_of(material);
    return fault.empty() ? Result<Material, Refusal>(material) : not_of_form(text, kByName, fault);
}

Result<Material, Refusal> parse_material(std::string_view text)
{
    return text.find('=') == std::string_view::npos ? parse_in_order(text)
                                                    : parse_material_keys(text);
}

} // namespace tactus
