// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/host_mesh/samples.hpp"
#include "tests/unit/host_mesh/support.hpp"

#include <gtest/gtest.h>

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
        {"a.off", "4OFF\n" + off},
        {"a.off", "nOFF\n" + off},
        {"a.off", "OFF BINARY\n" + off},
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

} // namespace

} // namespace tactus::test
