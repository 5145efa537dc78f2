// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/material.hpp"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

// Any thread except the haptic one, because strings allocate.
namespace tactus::hrtc
{

/// Materials given by --material, which override those of the scene.
class SceneMaterials
{
public:
    /// Parses options of the form MATERIAL, for all objects, or OBJECT:MATERIAL. Returns the first
    /// fault; empty if there is none.
    [[nodiscard]] std::string parse(std::span<const std::string> options);

    /// Material of the object called `name`: the one given for that name, or else for all, or else
    /// `said`, the object's material in the scene.
    [[nodiscard]] const Material& material_for(std::string_view name, const Material& said) const;

    /// Message on the first name with a material that none of `objects` has; empty if all have one.
    [[nodiscard]] std::string missing(std::span<const std::string> objects) const;

private:
    std::optional<Material> of_all_;
    std::map<std::string, Material, std::less<>> of_one_;
};

/// Message for an unknown object name: "no object is called 'cap'; cup?". If no name is similar,
/// the message lists some of the existing names.
[[nodiscard]] std::string no_such_object(std::string_view name,
                                         std::span<const std::string> objects);

} // namespace tactus::hrtc
