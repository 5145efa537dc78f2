// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/handle_cuts.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "tests/shared/certified_cut.hpp"
#include "tests/shared/surface_points.hpp"
#include "tests/unit/host_simplify/small_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <vector>

namespace tactus::test
{
namespace
{

void expect_equal(const Simplification& a, const Simplification& b)
{
    ASSERT_EQ(a.collapses.size(), b.collapses.size());
    for (std::size_t i = 0; i < a.collapses.size(); ++i)
    {
        ASSERT_EQ(a.collapses[i].vertex, b.collapses[i].vertex);
        ASSERT_EQ(a.collapses[i].parent, b.collapses[i].parent);
        ASSERT_EQ(a.collapses[i].round, b.collapses[i].round);
        ASSERT_EQ(a.collapses[i].star, b.collapses[i].star);
        ASSERT_EQ(a.collapses[i].error, b.collapses[i].error);
    }
    ASSERT_EQ(a.base_faces, b.base_faces);
    ASSERT_EQ(a.base_corners, b.base_corners);
    ASSERT_EQ(a.base_error, b.base_error);
}

} // namespace

TEST(Simplify, reaches_the_base_size_and_not_much_less)
{
    for (const auto& [name, mesh] : all_small_meshes())
    {
        SCOPED_TRACE(name);
        const Simplification sut = simplified(mesh, 60);
        EXPECT_LE(sut.base_faces.size(), 60U);
        EXPECT_GE(sut.base_faces.size(), 57U); // A tetrahedron vanishes entirely.
        EXPECT_EQ(sut.base_corners.size(), sut.base_faces.size());
        EXPECT_EQ(sut.base_error.size(), sut.base_faces.size());
    }
}

TEST(Simplify, does_nothing_to_a_mesh_that_is_small_enough)
{
    const QuantisedMesh mesh = make_sphere(180, 0);
    const Simplification sut = simplified(mesh, 180);
    EXPECT_TRUE(sut.collapses.empty());
    EXPECT_EQ(sut.rounds, 0U);
    EXPECT_EQ(sut.base_corners, mesh.faces);
}

TEST(Simplify, stops_a_closed_component_at_a_tetrahedron)
{
    EXPECT_EQ(simplified(make_sphere(320, 0.05), 1).base_faces.size(), 4U);
    EXPECT_EQ(simplified(make_needle_sphere(6, 40), 1).base_faces.size(), 4U);
}

TEST(Simplify, brings_an_open_component_down_to_one_face)
{
    const auto height = [](double x, double y) { return 0.1 * x * y; };
    EXPECT_EQ(simplified(make_grid(9, 7, height), 1).base_faces.size(), 1U);
    EXPECT_EQ(simplified(make_cone(3, 50), 1).base_faces.size(), 1U);
}

TEST(Simplify, keeps_the_genus)
{
    const Simplification sut = simplified(make_torus(720), 1);
    // No torus has fewer than 14 faces; the degree and star limits may stop it earlier.
    EXPECT_GE(sut.base_faces.size(), 14U);
    EXPECT_LE(sut.base_faces.size(), 30U);
}

TEST(Simplify, closes_holes_that_have_shrunk_to_three_edges)
{
    const auto hill = [](double x, double y) { return 0.1 * x * y; };
    const QuantisedMesh scan = make_scan(90, 90, hill);
    ASSERT_EQ(scan.faces.size(), 2U * 90 * 90 - 900);
    // A remaining hole has at least three edges, and as many faces around it.
    EXPECT_LE(simplified(scan, 100).base_faces.size(), 100U);
    EXPECT_EQ(simplified(scan, 1).base_faces.size(), 1U);
}

TEST(Simplify, keeps_a_large_hole_open_while_small_ones_close)
{
    // Window of 10 x 10 squares in the middle of 30 x 30.
    const auto is_in_window = [](std::uint32_t v)
    { return v % 31 >= 10 && v % 31 <= 20 && v / 31 >= 10 && v / 31 <= 20; };
    QuantisedMesh scan = make_scan(30, 30, [](double, double) { return 0.0; });
    std::erase_if(scan.faces,
                  [&](const auto& face) { return std::ranges::all_of(face, is_in_window); });
    QuantisedMesh frame;
    std::vector<std::optional<std::uint32_t>> number(scan.positions.size());
    for (auto& face : scan.faces)
    {
        for (std::uint32_t& v : face)
        {
            if (!number[v])
            {
                number[v] = static_cast<std::uint32_t>(frame.positions.size());
                frame.positions.push_back(scan.positions[v]);
            }
            v = *number[v];
        }
    }
    frame.faces = scan.faces;
    const Simplification sut = simplified(frame, 24);
    EXPECT_LE(sut.base_faces.size(), 24U);
    const Vec3 middle(32'768, 32'768, 32'768);
    EXPECT_GT(brute_distance(middle, faces_of(frame, sut.base_corners)), 5'000.0L);
}

TEST(Simplify, lets_components_vanish_where_they_can_not_shrink)
{
    const QuantisedMesh pair = join(make_sphere(180, 0), make_sphere(320, 0), 70'000);
    const QuantisedMesh spheres = join(pair, make_sphere(180, 0), 140'000);
    EXPECT_EQ(simplified(spheres, 12).base_faces.size(), 12U);
    EXPECT_EQ(simplified(spheres, 11).base_faces.size(), 8U);
    EXPECT_EQ(simplified(spheres, 1).base_faces.size(), 4U);
    EXPECT_EQ(simplified(make_crumbs(300, 0), 1).base_faces.size(), 1U);
    EXPECT_LE(simplified(make_crumbs(0, 50), 1).base_faces.size(), 4U);
    EXPECT_LE(simplified(make_crumbs(50, 50), 1).base_faces.size(), 4U);
}

TEST(Simplify, lets_a_component_vanish_into_the_nearest)
{
    // A crumb over a plate vanishes while the plate is still fine, so the plate keeps its corners.
    const auto flat = [](double, double) { return 0.0; };
    const QuantisedMesh plate = make_grid(8, 8, flat);
    QuantisedMesh crumb{{{0, 0, 0}, {40, 0, 0}, {0, 40, 0}}, {{0, 1, 2}}};
    for (auto& position : crumb.positions)
    {
        position = {plate.positions[40][0] + position[0], plate.positions[40][1] + position[1],
                    plate.positions[40][2] + 300};
    }
    const QuantisedMesh scene = join(plate, crumb, 0);
    const Simplification sut = simplified(scene, 2);
    EXPECT_LE(sut.base_faces.size(), 2U);
    EXPECT_GE(*std::ranges::max_element(sut.base_error), 299.0F);
    EXPECT_LE(*std::ranges::max_element(sut.base_error), 2'000.0F);
}

TEST(Simplify, leaves_what_has_no_collapse)
{
    const QuantisedMesh triangle{{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(simplified(triangle, 1).base_faces.size(), 1U);
    const QuantisedMesh pillow{{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}}, {{0, 1, 2}, {2, 1, 0}}};
    EXPECT_EQ(simplified(pillow, 1).base_faces.size(), 2U);
}

TEST(Simplify, collapses_needles_and_poles_of_high_valence)
{
    // The strict guard against thin faces alone would stop far above.
    EXPECT_LE(simplified(make_needle_sphere(10, 800), 500).base_faces.size(), 500U);
    EXPECT_LE(simplified(make_needle_sphere(3, 1500), 100).base_faces.size(), 100U);
}

TEST(Simplify, collapses_a_mesh_whose_vertices_share_one_place)
{
    QuantisedMesh mesh = make_sphere(320, 0);
    mesh.positions.assign(mesh.positions.size(), {5, 6, 7});
    EXPECT_LE(simplified(mesh, 20).base_faces.size(), 20U);
}

TEST(Simplify, needs_few_rounds)
{
    EXPECT_LE(simplified(make_sphere(20'480, 0.02), 200).rounds, 45U);
}

TEST(Simplify, gives_the_same_for_any_number_of_threads)
{
    for (const QuantisedMesh& mesh : {make_sphere(5'120, 0.05), make_needle_sphere(20, 150)})
    {
        const Simplification one = simplified(mesh, 100, 1);
        for (const unsigned threads : {2U, 3U, 8U})
        {
            expect_equal(one, simplified(mesh, 100, threads));
        }
    }
}

TEST(Simplify, reports_progress_and_can_be_cancelled)
{
    const QuantisedMesh mesh = make_sphere(1'280, 0);
    std::vector<std::size_t> left;
    SimplifyOptions options;
    options.base_faces = 100;
    options.progress = [&](std::size_t faces_left, std::size_t faces_total)
    {
        EXPECT_EQ(faces_total, mesh.faces.size());
        left.push_back(faces_left);
        return left.size() < 4;
    };
    const auto sut = simplify(mesh, options);
    ASSERT_FALSE(sut.has_value());
    EXPECT_EQ(sut.error().text.find("cancelled with "), 0U);
    ASSERT_EQ(left.size(), 4U);
    EXPECT_EQ(left[0], mesh.faces.size());
    EXPECT_GT(left[0], left[1]);
    EXPECT_GT(left[1], left[2]);
}

TEST(Simplify, refuses_options_out_of_range)
{
    const QuantisedMesh mesh = make_sphere(180, 0);
    SimplifyOptions options;
    options.base_faces = 0;
    EXPECT_EQ(simplify(mesh, options).error().text, "base_faces is 0; it must be 1 or more");
    options.base_faces = 1;
    options.threads = 0;
    EXPECT_EQ(simplify(mesh, options).error().text, "threads is 0; allowed are 1 to 256");
    options.threads = 257;
    EXPECT_FALSE(simplify(mesh, options).has_value());
}

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
