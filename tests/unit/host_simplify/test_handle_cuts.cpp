// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/handle_cuts.hpp"
#include "tests/shared/certified_cut.hpp"
#include "tests/shared/surface_points.hpp"
#include "tests/unit/host_simplify/small_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <span>
#include <vector>

namespace tactus::test
{
namespace
{

using Place = std::array<std::int32_t, 3>;

/// Faces by places, and the balance of each edge's directions.
struct Geometry
{
    std::vector<std::array<Place, 3>> faces;
    std::map<std::array<Place, 2>, int> surplus; ///< Excess of one direction over the other.

    explicit Geometry(const QuantisedMesh& mesh)
    {
        for (const auto& face : mesh.faces)
        {
            auto& places = faces.emplace_back();
            for (std::size_t i = 0; i < 3; ++i)
            {
                places[i] = mesh.positions[face[i]];
            }
            for (std::size_t i = 0; i < 3; ++i)
            {
                const Place& from = places[i];
                const Place& to = places[(i + 1) % 3];
                surplus[{std::min(from, to), std::max(from, to)}] += from < to ? 1 : -1;
            }
        }
    }
    [[nodiscard]] bool is_closed() const
    {
        return std::ranges::all_of(surplus, [](const auto& edge) { return edge.second == 0; });
    }
};

/// Genus of a closed mesh by Euler's formula.
long genus_of(const QuantisedMesh& mesh)
{
    std::set<std::array<std::uint32_t, 2>> edges;
    for (const auto& face : mesh.faces)
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            edges.insert(
                {std::min(face[i], face[(i + 1) % 3]), std::max(face[i], face[(i + 1) % 3])});
        }
    }
    return 1 - (std::ssize(mesh.positions) - std::ssize(edges) + std::ssize(mesh.faces)) / 2;
}

/// Simplifies and cuts until no ring is found; returns the number of cuts.
std::size_t cut_all(QuantisedMesh& mesh, std::uint32_t base_faces)
{
    std::size_t handles = 0;
    for (;;)
    {
        const auto rings = find_handle_rings(mesh, simplified(mesh, base_faces));
        if (rings.empty())
        {
            return handles;
        }
        handles += rings.size();
        std::vector<MeshEdge> edges;
        for (const auto& ring : rings)
        {
            edges.insert(edges.end(), ring.begin(), ring.end());
        }
        const std::size_t before = mesh.positions.size();
        const std::size_t copies = cut_open(mesh, edges);
        EXPECT_EQ(mesh.positions.size(), before + copies);
        // One copy for each vertex, and another where the ring touches the border of an earlier
        // cut.
        EXPECT_GE(copies, edges.size());
        EXPECT_TRUE(copies == edges.size() || handles > rings.size());
    }
}

} // namespace

TEST(HandleCuts, a_sheet_with_many_holes_comes_down_to_a_small_base)
{
    const QuantisedMesh sheet = make_perforated(6);
    ASSERT_EQ(genus_of(sheet), 36);
    EXPECT_GE(simplified(sheet, 4).base_faces.size(), 4U * 36 + 2); // Limit of the format.
    QuantisedMesh sut = sheet;
    EXPECT_EQ(cut_all(sut, 4), 36U); // Each cut removes one handle.
    EXPECT_LE(simplified(sut, 4).base_faces.size(), 4U);
}

TEST(HandleCuts, rings_vanish_like_any_piece)
{
    QuantisedMesh chain = make_torus(288);
    for (std::int32_t i = 1; i < 10; ++i)
    {
        chain = join(chain, make_torus(288), 40'000 * i);
    }
    EXPECT_GE(simplified(chain, 4).base_faces.size(), 140U);
    EXPECT_EQ(cut_all(chain, 4), 10U);
    EXPECT_LE(simplified(chain, 4).base_faces.size(), 4U);
}

TEST(HandleCuts, the_surface_stays_what_it_was_and_closed)
{
    for (const QuantisedMesh& mesh : {make_perforated(5), make_torus(720)})
    {
        const Geometry before(mesh);
        QuantisedMesh sut = mesh;
        EXPECT_GT(cut_all(sut, 4), 0U);
        const Geometry after(sut);
        EXPECT_EQ(after.faces, before.faces);
        EXPECT_TRUE(before.is_closed());
        EXPECT_TRUE(after.is_closed());
        EXPECT_TRUE(
            std::equal(mesh.positions.begin(), mesh.positions.end(), sut.positions.begin()));
    }
}

TEST(HandleCuts, the_certificate_holds_in_every_cut_of_the_forest)
{
    QuantisedMesh mesh = make_perforated(6);
    static_cast<void>(cut_all(mesh, 4));
    const Simplification forest = simplified(mesh, 4);
    PreparedMesh prepared;
    prepared.mesh = mesh;
    prepared.quantum_m = 1.0;
    const std::vector<Face> faces = faces_of(mesh, mesh.faces);
    const std::vector<Vec3> points = SurfacePoints(faces, 31).draw(6'000);
    std::mt19937 random(31);
    for (std::size_t run = 0; run < 8; ++run)
    {
        ForestReplay cut(forest, mesh.faces.size());
        cut.split_randomly(forest.collapses.size() * run / 8, random);
        EXPECT_FALSE(find_violation(cut_of(prepared, cut), points, 1e-9)) << "cut " << run;
    }
    const ForestReplay base(forest, mesh.faces.size());
    EXPECT_TRUE(find_violation(with_bounds_times(0.5, cut_of(prepared, base)), points, 1e-9));
}

TEST(HandleCuts, a_mesh_without_handles_has_none)
{
    for (const QuantisedMesh& mesh :
         {make_sphere(1'280, 0.1), make_scan(24, 24, [](double, double) { return 0.0; })})
    {
        EXPECT_TRUE(find_handle_rings(mesh, simplified(mesh, 200)).empty());
    }
}

TEST(HandleCuts, an_edge_that_is_cut_alone_opens_nothing)
{
    QuantisedMesh mesh = make_sphere(180, 0);
    const QuantisedMesh before = mesh;
    const MeshEdge edge{mesh.faces[0][0], mesh.faces[0][1]};
    EXPECT_EQ(cut_open(mesh, std::span(&edge, 1)), 0U);
    EXPECT_EQ(mesh.faces, before.faces);
}

} // namespace tactus::test
