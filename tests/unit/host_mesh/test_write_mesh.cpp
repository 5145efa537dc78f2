// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/write_mesh.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "tests/unit/host_mesh/support.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>

namespace tactus::test
{

namespace
{

/// Checks a round trip bit for bit; optionally the bytes a vertex of a PLY.
void expect_round_trip(const TriangleMesh& mesh, const std::string& name,
                       std::uintmax_t bytes_per_vertex = 0)
{
    const TemporaryFolder directory;
    const auto path = directory.path() / name;
    const auto written = write_mesh(path, mesh);
    ASSERT_TRUE(written) << written.error().text;
    EXPECT_EQ(directory.files(), 1U);
    if (bytes_per_vertex > 0)
    {
        const std::uintmax_t data =
            bytes_per_vertex * mesh.positions.size() + 13 * mesh.faces.size();
        EXPECT_GT(std::filesystem::file_size(path), data);
        EXPECT_LT(std::filesystem::file_size(path), data + 300);
    }
    const auto sut = read_mesh_file(path);
    ASSERT_TRUE(sut) << sut.error().text;
    EXPECT_EQ(sut.value().mesh.positions, mesh.positions);
    EXPECT_EQ(sut.value().mesh.faces, mesh.faces);
    EXPECT_TRUE(sut.value().notes.empty());
}

TEST(WriteMesh, writes_floats_where_they_are_exact)
{
    expect_round_trip({{{0, 0, 0}, {0.5, 0, 0}, {0, -3.25, 1e6}}, {{0, 1, 2}}}, "a.ply", 12);
}

TEST(WriteMesh, writes_doubles_where_one_coordinate_needs_them)
{
    expect_round_trip(tetrahedron(), "a.ply", 24);
    expect_round_trip({{{0, 0, 0}, {1e300, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, "a.ply", 24);
}

TEST(WriteMesh, writes_more_than_one_buffer)
{
    const auto mesh = make_shape(Shape::torus, 100'000);
    ASSERT_TRUE(mesh);
    expect_round_trip(mesh.value(), "a.ply", 24);
}

TEST(WriteMesh, an_obj_reads_back_bit_for_bit)
{
    expect_round_trip(tetrahedron(), "a.obj");
    expect_round_trip(
        {{{0.1, -1.0 / 3.0, 1e-300}, {1e300, 5e-324, 123456789.0}, {0, 1, 2}}, {{2, 1, 0}}},
        "a.OBJ");
    expect_round_trip(make_shape(Shape::bumpy_sphere, 50'000).value(), "a.obj");
}

TEST(WriteMesh, an_stl_holds_every_face_in_floats)
{
    const TemporaryFolder directory;
    const auto path = directory.path() / "a.stl";
    const TriangleMesh mesh = make_shape(Shape::torus, 20'000).value();
    const auto written = write_mesh(path, mesh);
    ASSERT_TRUE(written) << written.error().text;
    EXPECT_EQ(std::filesystem::file_size(path), 84 + 50 * mesh.faces.size());
    const auto sut = read_mesh_file(path);
    ASSERT_TRUE(sut) << sut.error().text;
    ASSERT_EQ(sut.value().mesh.faces.size(), mesh.faces.size());
    for (std::size_t face = 0; face < mesh.faces.size(); ++face)
    {
        for (std::size_t corner = 0; corner < 3; ++corner)
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                EXPECT_EQ(sut.value().mesh.positions[3 * face + corner][axis],
                          static_cast<float>(mesh.positions[mesh.faces[face][corner]][axis]));
            }
        }
    }
}

TEST(WriteMesh, an_stl_has_unit_normals_to_the_outside_and_none_without_area)
{
    const TemporaryFolder directory;
    const auto path = directory.path() / "a.stl";
    const TriangleMesh mesh{{{0, 0, 0}, {1e-30, 0, 0}, {0, 1e-30, 0}, {2e-30, 0, 0}},
                            {{0, 1, 2}, {0, 2, 1}, {0, 1, 3}}};
    ASSERT_TRUE(write_mesh(path, mesh));
    std::ifstream file(path, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(file), {});
    const auto normal_z = [&](std::size_t face)
    {
        float z = 0.0F;
        std::memcpy(&z, bytes.data() + 84 + 50 * face + 8, sizeof(z));
        return z;
    };
    EXPECT_EQ(normal_z(0), 1.0F);
    EXPECT_EQ(normal_z(1), -1.0F);
    EXPECT_EQ(normal_z(2), 0.0F);
}

TEST(WriteMesh, an_stl_is_refused_where_floats_would_join_vertices_or_overflow)
{
    const TemporaryFolder directory;
    TriangleMesh mesh = tetrahedron();
    for (auto& position : mesh.positions)
    {
        position[0] += 1e9;
    }
    const auto joined = write_mesh(directory.path() / "a.stl", mesh);
    ASSERT_FALSE(joined);
    EXPECT_NE(joined.error().text.find("a.stl: STL's 32-bit coordinates"), std::string::npos);
    EXPECT_FALSE(write_mesh(directory.path() / "b.stl",
                            {{{0, 0, 0}, {1e39, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}));
    // Two vertices in one place have no effect.
    EXPECT_TRUE(write_mesh(directory.path() / "c.stl",
                           {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 1, 0}}, {{0, 1, 2}}}));
    EXPECT_EQ(directory.files(), 1U);
}

TEST(WriteMesh, refuses_other_extensions_and_places)
{
    const TemporaryFolder directory;
    EXPECT_FALSE(has_mesh_extension("a.off"));
    EXPECT_FALSE(has_mesh_extension("stl"));
    EXPECT_TRUE(has_mesh_extension("b/a.Stl"));
    const auto extension = write_mesh(directory.path() / "a.off", tetrahedron());
    ASSERT_FALSE(extension);
    EXPECT_NE(extension.error().text.find("must end in .ply, .obj or .stl"), std::string::npos);
    EXPECT_FALSE(write_mesh(directory.path() / "no" / "a.ply", tetrahedron()));
    EXPECT_EQ(directory.files(), 0U);
}

} // namespace

} // namespace tactus::test
