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

/// `count` points, at least one, of a mesh with an area: spread evenly by area, one at a random
/// place of each equal share.
[[nodiscard]] std::vector<Vec3> surface_samples(const TriangleMesh& mesh, std::uint32_t count,
                                                std::uint64_t seed);

/// How far two surfaces lie apart, in the meshes' unit.
struct SurfaceError
{
    double rms{0.0};
    double max{0.0};
};

/// Measures other meshes against one: samples of each surface to the other surface, as many of
/// both; the root of the mean square of all of them and the largest. Corners are rounded to float.
class SurfaceReference
{
public:
    SurfaceReference(const TriangleMesh& original, std::uint32_t samples);
    SurfaceReference(const SurfaceReference&) = delete;
    SurfaceReference& operator=(const SurfaceReference&) = delete;

    /// About a microsecond a sample.
    [[nodiscard]] SurfaceError error_of(const TriangleMesh& other) const;

private:
    std::vector<Vec3> samples_;
    std::vector<test::Face> faces_;
    test::FaceTree tree_;
};

} // namespace tactus::bench
