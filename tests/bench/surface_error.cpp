// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/surface_error.hpp"

#include "tests/bench/bench_row.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/shared/random.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace tactus::bench
{

namespace
{

using Corners = std::array<Vec3, 3>;

Corners corners_of(const TriangleMesh& mesh, const std::array<std::uint32_t, 3>& face)
{
    Corners corners;
    for (std::size_t i = 0; i < 3; ++i)
    {
        const std::array<double, 3>& at = mesh.positions[face[i]];
        corners[i] = Vec3(at[0], at[1], at[2]);
    }
    return corners;
}

double area_of(const Corners& corners)
{
    return 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
}

/// Three independent values in 0 .. 1 for each index.
double unit(std::uint64_t seed, std::uint64_t index, std::uint64_t which)
{
    return 0.5 + 0.5 * test::signed_unit(seed, 3 * index + which);
}

Vec3 point_on(const Corners& corners, double s, double t)
{
    if (s + t > 1.0)
    {
        s = 1.0 - s;
        t = 1.0 - t;
    }
    return corners[0] + s * (corners[1] - corners[0]) + t * (corners[2] - corners[0]);
}

void add_distances(const std::vector<Vec3>& points, const test::FaceTree& tree, SurfaceError& sum)
{
    for (const Vec3& point : points)
    {
        const double distance = tree.nearest(point).distance_m;
        sum.rms += distance * distance;
        sum.max = std::max(sum.max, distance);
    }
}

} // namespace

std::vector<Vec3> surface_samples(const TriangleMesh& mesh, std::uint32_t count, std::uint64_t seed)
{
    double area = 0.0;
    for (const auto& face : mesh.faces)
    {
        area += area_of(corners_of(mesh, face));
    }
    std::vector<Vec3> samples;
    samples.reserve(count);
    double passed = 0.0; // Area of the faces before.
    const auto next = [&]
    {
        const std::size_t index = samples.size();
        return (static_cast<double>(index) + unit(seed, index, 0)) / count * area;
    };
    for (const auto& face : mesh.faces)
    {
        const Corners corners = corners_of(mesh, face);
        passed += area_of(corners);
        while (samples.size() < count && next() <= passed)
        {
            const std::size_t index = samples.size();
            samples.push_back(point_on(corners, unit(seed, index, 1), unit(seed, index, 2)));
        }
    }
    return samples;
}

SurfaceReference::SurfaceReference(const TriangleMesh& original, std::uint32_t samples)
    : samples_(surface_samples(original, samples, kSeed)), faces_(faces_of(original)), tree_(faces_)
{
}

SurfaceError SurfaceReference::error_of(const TriangleMesh& other) const
{
    const auto count = static_cast<std::uint32_t>(samples_.size());
    const std::vector<Vec3> others = surface_samples(other, count, kSeed + 1);
    const std::vector<test::Face> faces = faces_of(other);
    SurfaceError error;
    add_distances(samples_, test::FaceTree(faces), error);
    add_distances(others, tree_, error);
    error.rms = std::sqrt(error.rms / static_cast<double>(samples_.size() + others.size()));
    return error;
}

} // namespace tactus::bench
