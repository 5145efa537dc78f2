// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/simplify.hpp"
#include "rt_core/math/vec3.hpp"

#include <cstdint>

namespace tactus
{

/// A mesh vertex in quanta; exact, since a double holds every 32-bit integer.
[[nodiscard]] inline Vec3 grid_point(const QuantisedMesh& mesh, std::uint32_t vertex) noexcept
{
    const auto& p = mesh.positions[vertex];
    return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

} // namespace tactus
