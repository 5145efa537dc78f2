// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/limits.hpp"
#include "rt_core/records/local_surface.hpp"

#include <vector>

namespace tactus::test
{

/// Local surface with its own memory, the largest of a pair. Movable, not copyable.
struct OwnedSurface : LocalSurface
{
    OwnedSurface() : own_triangles(kMaxLocalTriangles), own_distances_m(kMaxLocalTriangles)
    {
        triangles = own_triangles;
        distances_m = own_distances_m;
    }
    OwnedSurface(const OwnedSurface&) = delete;
    OwnedSurface& operator=(const OwnedSurface&) = delete;
    OwnedSurface(OwnedSurface&&) noexcept = default;
    OwnedSurface& operator=(OwnedSurface&&) noexcept = default;
    ~OwnedSurface() = default;

    std::vector<LocalTriangle> own_triangles;
    std::vector<double> own_distances_m;
};

} // namespace tactus::test
