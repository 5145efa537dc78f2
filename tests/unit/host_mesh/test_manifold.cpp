// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/detail/prepare_steps.hpp"
#include "tests/unit/host_mesh/support.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

namespace tactus::test
{
namespace
{

/// Mesh with generic positions; only the indices matter.
TriangleMesh mesh_of(std::uint32_t vertices, std::vector<Face> faces)
{
    TriangleMesh mesh;
    for (std::uint32_t v = 0; v < vertices; ++v)
    {
        const double t = v;
        mesh.positions.push_back({t, t * t, t * t * t});
    }
    mesh.faces = std::move(faces);
    return mesh;
}

PreparedMesh manifold_of(const TriangleMesh& mesh)
{
    auto result = prepare_mesh(mesh, {.fit_diagonal_m = 1.0, .position_bits = 24});
    EXPECT_TRUE(result) << result.error().text;
    EXPECT_TRUE(result && is_manifold_with_borders(result.value().mesh));
    return result ? std::move(result).value() : PreparedMesh{};
}

std::vector<Face> disc(std::uint32_t apex, std::uint32_t first, std::uint32_t segments)
{
    std::vector<Face> faces;
    for (std::uint32_t i = 0; i < segments; ++i)
    {
        faces.push_back({apex, first + i, first + (i + 1) % segments});
    }
    return faces;
}

void join(std::vector<Face>& faces, const std::vector<Face>& more)
{
    faces.insert(faces.end(), more.begin(), more.end());
}

TEST(Checker, tells_manifold_from_not)
{
    EXPECT_TRUE(is_manifold_with_borders(tetrahedron().faces, 4));
    EXPECT_TRUE(is_manifold_with_borders(disc(0, 1, 5), 6));
    EXPECT_FALSE(is_manifold_with_borders(tetrahedron().faces, 5)) << "isolated vertex";
    EXPECT_FALSE(is_manifold_with_borders(std::vector<Face>{{0, 1, 2}, {0, 1, 3}}, 4));
    EXPECT_FALSE(is_manifold_with_borders(std::vector<Face>{{0, 1, 2}, {0, 3, 4}}, 5)) << "bow tie";
    auto cones = disc(0, 1, 4);
    join(cones, disc(0, 5, 4));
    EXPECT_FALSE(is_manifold_with_borders(cones, 9)) << "two cones";
    auto cone_and_flap = disc(0, 1, 4);
    join(cone_and_flap, {{0, 5, 6}});
    EXPECT_FALSE(is_manifold_with_borders(cone_and_flap, 7));
}

TEST(Manifold, cuts_a_book_of_three_pages_at_its_spine)
{
    const auto sut = manifold_of(mesh_of(5, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}));
    EXPECT_EQ(sut.cut_edges, 1U);
    EXPECT_EQ(sut.added_vertices, 4U);
    EXPECT_EQ(border_edges(sut.mesh.faces), 9U);
    EXPECT_EQ(sut.notes.size(), 2U);
}

TEST(Manifold, parts_two_cones_that_share_an_apex)
{
    auto faces = disc(0, 1, 6);
    join(faces, disc(0, 7, 4));
    const auto sut = manifold_of(mesh_of(11, faces));
    EXPECT_EQ(sut.cut_edges, 0U);
    EXPECT_EQ(sut.added_vertices, 1U);
    EXPECT_EQ(sut.mesh.positions.back(), sut.mesh.positions[0]);
    EXPECT_EQ(border_edges(sut.mesh.faces), 10U);
}

TEST(Manifold, cuts_a_moebius_strip_once)
{
    std::vector<Face> faces; // Five quads; the last one is joined with opposite orientation.
    for (std::uint32_t i = 0; i < 5; ++i)
    {
        const std::uint32_t a = 2 * i;
        const std::uint32_t b = 2 * i + 1;
        const std::uint32_t c = i < 4 ? 2 * i + 2 : 1;
        const std::uint32_t d = i < 4 ? 2 * i + 3 : 0;
        join(faces, {{a, c, b}, {b, c, d}});
    }
    const auto sut = manifold_of(mesh_of(10, faces));
    EXPECT_EQ(sut.cut_edges, 1U);
    EXPECT_EQ(sut.added_vertices, 2U);
    EXPECT_EQ(euler_characteristic(sut.mesh.faces, sut.mesh.positions.size()), 1)
        << "a plain strip";
}

TEST(Manifold, cuts_round_a_flipped_face)
{
    auto mesh = tetrahedron();
    std::swap(mesh.faces[1][0], mesh.faces[1][1]);
    const auto sut = manifold_of(mesh);
    EXPECT_EQ(sut.cut_edges, 3U);
    EXPECT_EQ(border_edges(sut.mesh.faces), 6U);
    EXPECT_EQ(sut.mesh.positions.size(), 7U);
}

TEST(Manifold, parts_a_two_sided_sheet_into_two_whole_sheets)
{
    for (const bool interleaved : {false, true})
    {
        std::vector<Face> faces;
        for (const Face& f : disc(0, 1, 8))
        {
            faces.push_back(f);
            if (interleaved)
            {
                faces.push_back({f[0], f[2], f[1]});
            }
        }
        for (const Face& f : disc(0, 1, 8))
        {
            if (!interleaved)
            {
                faces.push_back({f[0], f[2], f[1]});
            }
        }
        const auto sut = manifold_of(mesh_of(9, faces));
        EXPECT_EQ(sut.mesh.positions.size(), 18U);
        EXPECT_EQ(border_edges(sut.mesh.faces), 16U);
        EXPECT_EQ(sut.cut_edges, 0U);
    }
}

TEST(Manifold, joins_a_fin_to_neither_side)
{
    // Closed tetrahedron with a loose face on one edge.
    auto mesh = tetrahedron();
    mesh.positions.push_back({-1, -1, -1});
    mesh.faces.push_back({0, 1, 4});
    const auto sut = manifold_of(mesh);
    EXPECT_EQ(sut.mesh.faces.size(), 5U);
    EXPECT_EQ(sut.cut_edges, 1U);
    // The tetrahedron's fans at both ends of the edge still share both ends, so it stays closed.
    EXPECT_EQ(border_edges(sut.mesh.faces), 3U);
}

TEST(Manifold, splits_two_cubes_that_share_an_edge_into_closed_pieces)
{
    auto mesh = tetrahedron();
    // Second tetrahedron on the edge (0, 1).
    mesh.positions.push_back({0, -1, 0});
    mesh.positions.push_back({0.1, -0.3, -1});
    join(mesh.faces, {{0, 5, 1}, {0, 4, 5}, {1, 5, 4}, {0, 1, 4}});
    const auto sut = manifold_of(mesh);
    EXPECT_EQ(sut.cut_edges, 1U);
    EXPECT_EQ(border_edges(sut.mesh.faces), 0U);
    EXPECT_EQ(sut.mesh.positions.size(), 8U);
}

/// Random faces over so few vertices that most faults occur.
rc::Gen<std::vector<Face>> arbitrary_soup(std::uint32_t vertices)
{
    return rc::gen::container<std::vector<Face>>(
        rc::gen::container<Face>(rc::gen::inRange<std::uint32_t>(0, vertices)));
}

/// Checks the result for any input: manifold, with the same faces in the same places.
void check_soup(const std::vector<Face>& faces, std::uint32_t vertices)
{
    const auto mesh = mesh_of(vertices, faces);
    std::vector<Face> expected; // Expected clean-up, the slow way.
    for (const Face& f : faces)
    {
        const Face second{f[1], f[2], f[0]};
        const Face third{f[2], f[0], f[1]};
        const bool is_new =
            std::none_of(expected.begin(), expected.end(),
                         [&](const Face& e) { return e == f || e == second || e == third; });
        if (f[0] != f[1] && f[1] != f[2] && f[2] != f[0] && is_new)
        {
            expected.push_back(f);
        }
    }
    const auto sut =
        prepare_mesh(mesh, {.fit_diagonal_m = 1.0, .position_bits = 24, .keeps_winding = true});
    RC_ASSERT(sut.has_value() == !expected.empty());
    if (!sut)
    {
        return;
    }
    const auto& out = sut.value();
    RC_ASSERT(is_manifold_with_borders(out.mesh));
    RC_ASSERT(out.mesh.faces.size() == expected.size());
    const double scale = 1.0 / out.quantum_m;
    const auto& source = mesh.positions;
    double longest = 0.0;
    Point low = source[expected[0][0]];
    Point high = low;
    for (const Face& f : expected)
    {
        for (const auto v : f)
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                low[axis] = std::min(low[axis], source[v][axis]);
                high[axis] = std::max(high[axis], source[v][axis]);
            }
        }
    }
    longest = std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
    for (std::size_t f = 0; f < expected.size(); ++f)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                const double wanted = (source[expected[f][k]][axis] - low[axis]) / longest * scale;
                RC_ASSERT(std::abs(out.mesh.positions[out.mesh.faces[f][k]][axis] - wanted) <
                          0.5 + 1e-6);
            }
        }
    }
}

RC_GTEST_PROP(Manifold, holds_on_random_soups_over_few_vertices, ())
{
    const auto vertices = *rc::gen::inRange<std::uint32_t>(3, 8);
    check_soup(*arbitrary_soup(vertices), vertices);
}

RC_GTEST_PROP(Manifold, holds_on_random_soups_over_more_vertices, ())
{
    check_soup(*rc::gen::resize(300, arbitrary_soup(20)), 20);
}

/// A manifold mesh with faces in any order and rotation stays unchanged.
RC_GTEST_PROP(Manifold, does_not_touch_manifold_meshes, ())
{
    const auto segments = *rc::gen::inRange<std::uint32_t>(4, 40);
    auto faces = disc(0, 1, segments);
    for (const Face& f : disc(segments + 1, 1, segments))
    {
        faces.push_back({f[0], f[2], f[1]});
    }
    const auto turns = *rc::gen::container<std::vector<int>>(faces.size(), rc::gen::inRange(0, 3));
    for (std::size_t i = 0; i < faces.size(); ++i)
    {
        std::rotate(faces[i].begin(), faces[i].begin() + turns[i], faces[i].end());
        std::swap(faces[i], faces[static_cast<std::size_t>(turns[i]) * i / 3]);
    }
    auto split = faces;
    const auto sut = detail::split_into_manifold(split, segments + 2);
    RC_ASSERT(split == faces);
    RC_ASSERT(sut.cut_edges == 0U);
    RC_ASSERT(sut.copy_of.empty());
}

} // namespace
} // namespace tactus::test
