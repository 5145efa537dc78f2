// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
// Refusals of meshes by simplify(), and their wording.
#include "host_tools/simplify/collapse_mesh.hpp"
#include "tests/unit/host_simplify/small_meshes.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

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

TEST(EdgeMatch, refuses_what_is_no_manifold_by_what_is_wrong)
{
    const std::vector<std::pair<decltype(QuantisedMesh::faces), std::string>> cases{
        {{}, "the mesh has 0 faces; allowed are 1 to 536870910"},
        {{{0, 1, 2}, {0, 2, 5}}, "face 1 names vertex 5, but the mesh has 5 vertices"},
        {{{0, 1, 2}, {3, 1, 3}}, "face 1 names a vertex twice; its three corners must differ"},
        {{{0, 1, 2}, {1, 0, 3}, {1, 0, 4}},
         "the edge between vertices 0 and 1 has more than two faces: 0, 1 and 2"},
        {{{0, 1, 2}, {0, 1, 3}},
         "faces 0 and 1 run along the edge between vertices 0 and 1 in the same direction"},
        {{{0, 1, 2}, {0, 3, 4}}, "the faces of vertex 0 form more than one fan"},
        {{{0, 1, 2}, {2, 1, 3}}, "vertex 4 belongs to no face"}};
    QuantisedMesh mesh = five_points();
    for (const auto& [faces, words] : cases)
    {
        mesh.faces = faces;
        EXPECT_EQ(refusal(mesh), words);
    }
    for (const std::int32_t off : {-1, 1 << 24})
    {
        mesh.positions[4][1] = off;
        EXPECT_EQ(refusal(mesh), "vertex 4 is off the grid; coordinates are 0 to 16777215");
    }
    // Two closed meshes that touch in a vertex.
    const QuantisedMesh closed = make_sphere(180, 0);
    QuantisedMesh touching = join(closed, closed, 0);
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

} // namespace tactus::test
