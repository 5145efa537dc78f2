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

// Any thread, but not the haptic one: texts allocate.
namespace tactus::hrtc
{

/// What --material says of a scene's objects, which goes before what the scene says.
class SceneMaterials
{
public:
    /// Each is MATERIAL, of all objects, or OBJECT:MATERIAL. Returns what is wrong with them; empty
    /// when all is well.
    [[nodiscard]] std::string take(std::span<const std::string> options);

    /// How an object of this name feels, of which the scene says `said`.
    [[nodiscard]] const Material& felt(std::string_view name, const Material& said) const;

    /// A line about the first name that none of the objects has; empty when all are there.
    [[nodiscard]] std::string missing(std::span<const std::string> objects) const;

private:
    std::optional<Material> of_all_;
    std::map<std::string, Material, std::less<>> of_one_;
};

/// What a user who named an object meant: "no object is called 'cap'; cup?", or with no name near
/// it some of those that there are.
[[nodiscard]] std::string no_such_object(std::string_view name,
                                         std::span<const std::string> objects);

} // namespace tactus::hrtc
