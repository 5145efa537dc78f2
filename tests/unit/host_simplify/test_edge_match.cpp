// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
// Refusals of meshes by simplify(), and their wording.
#include "host_tools/simplify/edge_match.hpp"
#include "tests/unit/host_simplify/small_meshes.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tactus::test
{

namespace
{

/// Five points without faces.
QuantisedMesh five_points()
{
    return {{{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {0, 0, 9}, {9, 9, 9}}, {}};
}

std::string refusal(const QuantisedMesh& mesh)
{
    const auto result = simplify(mesh, {});
    return result.has_value() ? "" : result.error().text;
}

} // namespace

TEST(EdgeMatch, finds_the_face_across_each_edge)
{
    QuantisedMesh mesh = five_points();
    mesh.faces = {{0, 1, 2}, {3, 2, 1}};
    const auto sut = match_edges(mesh);
    constexpr std::uint32_t kNone = Collapse::kNoFace;
    const FaceNeighbours expected{{kNone, 1, kNone}, {kNone, 0, kNone}};
    EXPECT_EQ(sut.value(), expected);
}

TEST(EdgeMatch, refuses_a_mesh_without_faces)
{
    EXPECT_EQ(refusal(five_points()), "the mesh has 0 faces; allowed are 1 to 536870910");
}

TEST(EdgeMatch, refuses_a_vertex_out_of_range)
{
    QuantisedMesh mesh = five_points();
    mesh.faces = {{0, 1, 2}, {0, 2, 5}};
    EXPECT_EQ(refusal(mesh), "face 1 names vertex 5, but the mesh has 5 vertices");
}

TEST(EdgeMatch, refuses_a_face_that_names_a_vertex_twice)
{
    QuantisedMesh mesh = five_points();
    mesh.faces = {{0, 1, 2}, {3, 1, 3}};
    EXPECT_EQ(refusal(mesh), "face 1 names a vertex twice; its three corners must differ");
}

TEST(EdgeMatch, refuses_a_position_off_the_grid)
{
    QuantisedMesh mesh = five_points();
    mesh.faces = {{0, 1, 2}};
    mesh.positions[4][1] = -1;
    EXPECT_EQ(refusal(mesh), "vertex 4 is off the grid; coordinates are 0 to 16777215");
    mesh.positions[4][1] = 1 << 24;
    EXPECT_EQ(refusal(mesh), "vertex 4 is off the grid; coordinates are 0 to 16777215");
}

TEST(EdgeMatch, refuses_an_edge_with_three_faces)
{
    QuantisedMesh mesh = five_points();
    mesh.faces = {{0, 1, 2}, {1, 0, 3}, {1, 0, 4}};
    EXPECT_EQ(refusal(mesh),
              "the edge between vertices 0 and 1 has more than two faces: 0, 1 and 2");
}

TEST(EdgeMatch, refuses_two_faces_that_run_along_an_edge_in_the_same_direction)
{
    QuantisedMesh mesh = five_points();
    mesh.faces = {{0, 1, 2}, {0, 1, 3}};
    EXPECT_EQ(refusal(mesh), "faces 0 and 1 run along the edge between vertices 0 and 1 in the "
                             "same direction");
}

TEST(EdgeMatch, refuses_a_vertex_with_two_fans)
{
    QuantisedMesh mesh = five_points();
    mesh.faces = {{0, 1, 2}, {0, 3, 4}};
    EXPECT_EQ(refusal(mesh), "the faces of vertex 0 form more than one fan");
    QuantisedMesh closed = make_sphere(180, 0);
    const auto other = join(closed, closed, 0);
    QuantisedMesh touching = other;
    const auto first = static_cast<std::uint32_t>(closed.positions.size());
    for (auto& face : touching.faces)
    {
        for (auto& vertex : face)
        {
            vertex = vertex == first ? 0 : (vertex > first ? vertex - 1 : vertex);
        }
    }
    touching.positions.erase(touching.positions.begin() + first);
    EXPECT_EQ(refusal(touching), "the faces of vertex 0 form more than one fan");
}

TEST(EdgeMatch, refuses_a_vertex_without_faces)
{
    QuantisedMesh mesh = five_points();
    mesh.faces = {{0, 1, 2}, {2, 1, 3}};
    EXPECT_EQ(refusal(mesh), "vertex 4 belongs to no face");
}

} // namespace tactus::test
