// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/similarity.hpp"
#include "rt_core/records/material.hpp"

#include <cstddef>
#include <string>

namespace tactus::hrtc
{

/// Object that is in the scene from the start.
struct PlacedObject
{
    std::size_t model{0}; ///< Index of its model in Options::models.
    Similarity place;
    Material material;
    bool has_place{false}; ///< True if --place or the server has given the place.
    bool has_material{false};
    std::string name; ///< Name in its scene; empty: none.
};

} // namespace tactus::hrtc
