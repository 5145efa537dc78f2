// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"
#include "rt_core/math/vec3.hpp"
#include "tests/shared/brute_force.hpp"
#include "tests/shared/face_tree.hpp"

#include <cstdint>
#include <vector>

namespace tactus::bench
{

/// `count` points, at least one, of a mesh with an area: one at a random place of each equal share
/// of the area.
[[nodiscard]] std::vector<Vec3> surface_samples(const TriangleMesh& mesh, std::uint32_t count,
                                                std::uint64_t seed);

/// Distance between two surfaces, in the meshes' unit.
struct SurfaceError
{
    double rms{0.0};
    double max{0.0};
};

/// Measures other meshes against one: as many samples of each surface to the other surface; root of
/// the mean square and maximum. Corners are rounded to float.
class SurfaceReference
{
public:
    SurfaceReference(const TriangleMesh& original, std::uint32_t samples);
    SurfaceReference(const SurfaceReference&) = delete;
    SurfaceReference& operator=(const SurfaceReference&) = delete;

    /// Error of the other mesh; about a microsecond a sample.
    [[nodiscard]] SurfaceError error_of(const TriangleMesh& other) const;

private:
    std::vector<Vec3> samples_;
    std::vector<test::Face> faces_;
    test::FaceTree tree_;
};

} // namespace tactus::bench
