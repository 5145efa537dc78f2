// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/mesh_refinement.hpp"

#include "tests/shared/random.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <unordered_map>

namespace tactus::bench
{

namespace
{

Eigen::Vector3d position(const TriangleMesh& mesh, std::uint32_t vertex)
{
    const std::array<double, 3>& place = mesh.positions[vertex];
    return {place[0], place[1], place[2]};
}

/// Averages over a vertex's faces.
struct Vicinity
{
    Eigen::Vector3d normal{0.0, 0.0, 0.0};
    double edge_length_sum{0.0};
    std::uint32_t edges{0};
};

std::vector<Vicinity> vicinities(const TriangleMesh& mesh)
{
    std::vector<Vicinity> all(mesh.positions.size());
    for (const auto& face : mesh.faces)
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            const Eigen::Vector3d here = position(mesh, face[i]);
            const Eigen::Vector3d next = position(mesh, face[(i + 1) % 3]) - here;
            const Eigen::Vector3d last = position(mesh, face[(i + 2) % 3]) - here;
            Vicinity& vicinity = all[face[i]];
            vicinity.normal += next.cross(last);
            vicinity.edge_length_sum += next.norm() + last.norm();
            vicinity.edges += 2;
        }
    }
    return all;
}

} // namespace

TriangleMesh subdivided(const TriangleMesh& mesh)
{
    TriangleMesh fine{mesh.positions, {}};
    fine.faces.reserve(4 * mesh.faces.size());
    std::unordered_map<std::uint64_t, std::uint32_t> midpoints;
    midpoints.reserve(2 * mesh.faces.size());
    const auto midpoint = [&](std::uint32_t a, std::uint32_t b)
    {
        const std::uint64_t edge = (std::uint64_t{std::min(a, b)} << 32U) | std::max(a, b);
        const auto [found, is_new] =
            midpoints.try_emplace(edge, static_cast<std::uint32_t>(fine.positions.size()));
        if (is_new)
        {
            const Eigen::Vector3d middle = 0.5 * (position(mesh, a) + position(mesh, b));
            fine.positions.push_back({middle.x(), middle.y(), middle.z()});
        }
        return found->second;
    };
    for (const auto& [a, b, c] : mesh.faces)
    {
        const std::uint32_t ab = midpoint(a, b);
        const std::uint32_t bc = midpoint(b, c);
        const std::uint32_t ca = midpoint(c, a);
        fine.faces.insert(fine.faces.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    return fine;
}

TriangleMesh with_normal_noise(const TriangleMesh& mesh, double share, std::uint64_t seed)
{
    TriangleMesh noisy = mesh;
    const std::vector<Vicinity> all = vicinities(mesh);
    for (std::size_t i = 0; i < all.size(); ++i)
    {
        const double length = all[i].normal.norm();
        if (!(length > 0.0))
        {
            continue; // No face, or faces that cancel out: there is no direction to move in.
        }
        const double way =
            share * test::signed_unit(seed, i) * all[i].edge_length_sum / all[i].edges / length;
        for (int axis = 0; axis < 3; ++axis)
        {
            noisy.positions[i][static_cast<std::size_t>(axis)] += way * all[i].normal[axis];
        }
    }
    return noisy;
}

} // namespace tactus::bench
