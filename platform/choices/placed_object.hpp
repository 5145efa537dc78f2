// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/similarity.hpp"
#include "rt_core/records/material.hpp"

#include <cstddef>
#include <string>

namespace tactus::hrtc
{

/// An object that is there from the start.
struct PlacedObject
{
    std::size_t model{0}; ///< The place of its model in Options::models.
    Similarity place;
    Material material;
    bool has_place{false}; ///< Given by --place or by the host.
    bool has_material{false};
    std::string name; ///< In its scene; empty: it has none.
};

} // namespace tactus::hrtc
