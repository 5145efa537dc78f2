// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/simplify/simplify.hpp"
#include "tests/unit/host_simplify/small_meshes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <optional>
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

} // namespace tactus::test
