// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/scene_materials.hpp"

#include "transport/base/printable.hpp"
#include "transport/base/suggestions.hpp"
#include "transport/material_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace tactus::hrtc
{

namespace
{

/// Largest number of names in a message; a scene may have thousands.
constexpr std::size_t kNamesTold = 8;

} // namespace

std::string SceneMaterials::parse(std::span<const std::string> options)
{
    for (const std::string& text : options)
    {
        const std::size_t colon = text.find(':');
        const bool is_of_all = colon == std::string::npos;
        const auto material = parse_material(is_of_all ? text : text.substr(colon + 1));
        if (!material)
        {
            return "--material: " + material.error().text;
        }
        const std::string name = is_of_all ? "" : text.substr(0, colon);
        if (!is_of_all && name.empty())
        {
            return fmt::format("--material: '{}': an object's name is missing before the colon",
                               printable(text));
        }
        const bool is_new = is_of_all ? !of_all_ : !of_one_.contains(name);
        if (!is_new)
        {
            return is_of_all ? "--material: is given twice for all objects of the scene; use "
                               "OBJECT:MATERIAL for one object"
                             : fmt::format("--material: is given twice for '{}'", printable(name));
        }
        if (is_of_all)
        {
            of_all_ = material.value();
        }
        else
        {
            of_one_[name] = material.value();
        }
    }
    return {};
}

const Material& SceneMaterials::material_for(std::string_view name, const Material& said) const
{
    const auto one = of_one_.find(name);
    return one != of_one_.end() ? one->second : of_all_ ? *of_all_ : said;
}

std::string SceneMaterials::missing(std::span<const std::string> objects) const
{
    for (const auto& [name, material] : of_one_)
    {
        if (std::ranges::find(objects, name) == objects.end())
        {
            return "--material: " + no_such_object(name, objects);
        }
    }
    return {};
}

std::string no_such_object(std::string_view name, std::span<const std::string> objects)
{
    const std::vector<std::string_view> words(objects.begin(), objects.end());
    const std::string nearest = nearest_word(name, words);
    if (!nearest.empty())
    {
        return fmt::format("no object is called '{}'; {}?", printable(name), nearest);
    }
    const std::size_t told = std::min(objects.size(), kNamesTold);
    return fmt::format("no object is called '{}'; there are {}{}", printable(name),
                       fmt::join(objects.first(told), ", "),
                       told < objects.size() ? fmt::format(" and {} more", objects.size() - told)
                                             : "");
}

} // namespace tactus::hrtc
