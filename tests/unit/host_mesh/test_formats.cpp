// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/write_mesh.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "tests/unit/host_mesh/samples.hpp"
#include "tests/unit/host_mesh/support.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>

/// Features of single formats.
namespace tactus::test
{
namespace
{

std::vector<Face> faces_of(const std::string& name, const std::string& text)
{
    const auto sut = read_bytes(name, text);
    EXPECT_TRUE(sut) << sut.error().text;
    return sut ? sut.value().mesh.faces : std::vector<Face>{};
}

const std::string kObjSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

TEST(ReadObj, notes_lines_that_it_does_not_understand)
{
    using namespace std::string_literals;
    const auto sut = read_bytes("a.obj", kObjSquare + "garbage here\nf 1 2 3\n\0f 1 2 4\n"s);
    ASSERT_TRUE(sut);
    EXPECT_EQ(sut.value().mesh.faces, (std::vector<Face>{{0, 1, 2}}));
    EXPECT_EQ(sut.value().notes,
              std::vector<std::string>{"2 lines not understood, the first is line 5"});
}

TEST(ReadStl, does_not_mind_normals_that_are_not_numbers)
{
    std::string text = as_ascii_stl(tetrahedron());
    text.replace(text.find("0 0 0"), 5, "nan nan nan");
    EXPECT_EQ(faces_of("a.stl", text).size(), 4U);
}

std::string strip_ply(const std::string& list)
{
    return "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\n"
           "property float z\nelement tristrips 1\nproperty list int int vertex_indices\n"
           "end_header\n0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n2 1 0\n" +
           list + "\n";
}

TEST(ReadPly, turns_every_second_face_of_a_strip)
{
    EXPECT_EQ(faces_of("a.ply", strip_ply("5 1 0 3 2 5")),
              (std::vector<Face>{{1, 0, 3}, {3, 0, 2}, {3, 2, 5}}));
}

TEST(ReadPly, starts_strips_anew_after_minus_one)
{
    EXPECT_EQ(faces_of("a.ply", strip_ply("8 1 0 3 2 -1 3 2 5")),
              (std::vector<Face>{{1, 0, 3}, {3, 0, 2}, {3, 2, 5}}));
    EXPECT_EQ(faces_of("a.ply", strip_ply("9 -1 -1 1 0 3 -1 3 2 5")),
              (std::vector<Face>{{1, 0, 3}, {3, 2, 5}}));
}

TEST(ReadPly, drops_faces_that_only_steer_a_strip_but_counts_them)
{
    EXPECT_EQ(faces_of("a.ply", strip_ply("7 1 0 3 3 2 5 4")),
              (std::vector<Face>{{1, 0, 3}, {2, 3, 5}, {2, 5, 4}}));
}

TEST(ReadPly, reads_every_property_type_and_passes_over_the_rest)
{
    std::string bytes =
        "ply\nformat binary_big_endian 1.0\nobj_info x\nelement vertex 3\n"
        "property uchar red\nproperty float32 x\nproperty int16 y\n"
        "property uint8 z\nproperty list uchar ushort junk\nelement blob 2\n"
        "property double w\nelement face 1\nproperty list ushort uint vertex_index\n"
        "property list uchar float texcoord\nend_header\n";
    for (std::uint8_t v = 0; v < 3; ++v)
    {
        append(bytes, std::uint8_t{7});
        append(bytes, 0.5F * static_cast<float>(v), true);
        append(bytes, static_cast<std::int16_t>(v == 1 ? -300 : 0), true);
        append(bytes, static_cast<std::uint8_t>(v * 100));
        append(bytes, std::uint8_t{2});
        append(bytes, std::uint32_t{0});
    }
    bytes.append(16, '\x01');
    append(bytes, std::uint16_t{3}, true);
    for (const std::uint32_t v : {2U, 0U, 1U})
    {
        append(bytes, v, true);
    }
    append(bytes, std::uint8_t{1});
    append(bytes, 1.0F, true);
    const auto sut = read_bytes("a.ply", bytes);
    ASSERT_TRUE(sut) << sut.error().text;
    EXPECT_EQ(sut.value().mesh.positions,
              (std::vector<Point>{{0.0, 0.0, 0.0}, {0.5, -300.0, 100.0}, {1.0, 0.0, 200.0}}));
    EXPECT_EQ(sut.value().mesh.faces, (std::vector<Face>{{2, 0, 1}}));
}

TEST(ReadPly, cuts_polygons_into_triangles_and_drops_lines)
{
    std::string text = as_ascii_ply(tetrahedron());
    const auto at = text.find("3 0 2 1\n3 0 1 3");
    ASSERT_NE(at, std::string::npos);
    text.replace(at, 15, "4 0 2 1 3\n2 0 1");
    const auto sut = read_bytes("a.ply", text);
    ASSERT_TRUE(sut) << sut.error().text;
    EXPECT_EQ(sut.value().mesh.faces,
              (std::vector<Face>{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}));
    EXPECT_EQ(sut.value().notes,
              std::vector<std::string>{"1 polygon with fewer than 3 corners dropped"});
}

/// Each refusal is one line with these words.
TEST(ReadText, refuses_what_is_broken)
{
    const std::string off = "3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    struct Case
    {
        std::string name;
        std::string text;
        std::string words{};
    };
    std::vector<Case> cases{
        {"a.obj", kObjSquare + "f 1 2\n", "holds no faces"},
        {"a.obj", "v 1 2\nv 1 2 3\nf 1 1 1\n", "line 1"},
        {"a.obj", kObjSquare + "f 1 2 x\n", "'x'"},
        {"a.off", "PLY\n" + off},
        {"a.off", "OFF\n-3 1 0\n0 0 0\n"},
        {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n"},
        {"a.off", "OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n"},
        {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n9999999999 0 1 2\n"},
        {"a.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
                  "endloop\nendfacet\nendsolid x\n"},
        {"a.ply", strip_ply("3 -2 0 1")},
        {"a.ply", strip_ply("3 6 0 1")},
    };
    const std::pair<std::string, std::string> changes[]{
        {"format ascii 1.0\n", ""},
        {"format ascii", "format weird"},
        {"element vertex 4", "element vertex"},
        {"element vertex 4", "element vertex -4"},
        {"property double x\n", ""},
        {"property double x", "property double y"},
        {"property double x", "property quad x"},
        {"property double x", "property double"},
        {"list uchar int", "list float int"},
        {"element vertex 4\n", ""},
        {"element vertex 4", "element vertices 4"},
        {"comment", "commment"},
        {"end_header\n", ""},
        {"3 0 2 1", "-3 0 2 1"},
        {"3 0 2 1", "2.5 0 2 1"},
        {"3 0 2 1", "nan 0 2 1"},
        {"3 0 2 1", "1e300 0 2 1"},
    };
    for (const auto& [from, to] : changes)
    {
        std::string text = as_ascii_ply(tetrahedron());
        const auto at = text.find(from);
        ASSERT_NE(at, std::string::npos) << from;
        cases.push_back({"a.ply", text.replace(at, from.size(), to)});
    }
    for (const Case& wrong : cases)
    {
        const std::string said = refusal(read_bytes(wrong.name, wrong.text));
        EXPECT_TRUE(!said.empty() && said.find(wrong.words) != std::string::npos)
            << said << ": " << wrong.text;
    }
}

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
