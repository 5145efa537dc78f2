// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/collapse_mesh.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/math/vec3.hpp"

namespace tactus
{

/// The memoryless quadric of a vertex: area-weighted squared distance to the planes of its
/// *present* faces. Ignoring removed faces beats accumulating them by a fifth in RMS error, and
/// needs no memory between rounds.
class PlaneQuadric
{
public:
    PlaneQuadric(const QuantisedMesh& mesh, const VertexRing& ring) noexcept;

    /// Cost of moving the vertex to `point`, in quanta^4. Faces without area have no plane and do
    /// not count.
    [[nodiscard]] double at(const Vec3& point) const noexcept;

private:
    Vec3 vertex_;
    /// Unit normals times the root of the area.
    StaticVector<Vec3, kMaxStarFaces> planes_;
};

} // namespace tactus
