// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/write_mesh.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "tests/unit/host_mesh/support.hpp"

#include <gtest/gtest.h>

namespace tactus::test
{

namespace
{

void expect_round_trip(const TriangleMesh& mesh, std::uintmax_t bytes_per_vertex)
{
    const TempDirectory directory;
    const auto path = directory.path() / "a.ply";
    const auto written = write_mesh(path, mesh);
    ASSERT_TRUE(written) << written.error().text;
    EXPECT_EQ(directory.files(), 1U);
    const std::uintmax_t data = bytes_per_vertex * mesh.positions.size() + 13 * mesh.faces.size();
    EXPECT_GT(std::filesystem::file_size(path), data);
    EXPECT_LT(std::filesystem::file_size(path), data + 300);
    const auto sut = read_mesh_file(path);
    ASSERT_TRUE(sut) << sut.error().text;
    EXPECT_EQ(sut.value().mesh.positions, mesh.positions);
    EXPECT_EQ(sut.value().mesh.faces, mesh.faces);
    EXPECT_TRUE(sut.value().notes.empty());
}

TEST(WriteMesh, writes_floats_where_they_are_exact)
{
    expect_round_trip({{{0, 0, 0}, {0.5, 0, 0}, {0, -3.25, 1e6}}, {{0, 1, 2}}}, 12);
}

TEST(WriteMesh, writes_doubles_where_one_coordinate_needs_them)
{
    expect_round_trip(tetrahedron(), 24);
    expect_round_trip({{{0, 0, 0}, {1e300, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}, 24);
}

TEST(WriteMesh, writes_more_than_one_buffer)
{
    const auto mesh = make_shape(Shape::torus, 100'000);
    ASSERT_TRUE(mesh);
    expect_round_trip(mesh.value(), 24);
}

TEST(WriteMesh, refuses_other_extensions_and_places)
{
    const TempDirectory directory;
    const auto extension = write_mesh(directory.path() / "a.obj", tetrahedron());
    ASSERT_FALSE(extension);
    EXPECT_NE(extension.error().text.find("must end in .ply"), std::string::npos);
    EXPECT_FALSE(write_mesh(directory.path() / "no" / "a.ply", tetrahedron()));
    EXPECT_EQ(directory.files(), 0U);
}

} // namespace

} // namespace tactus::test
