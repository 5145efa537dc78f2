// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/host_mesh/samples.hpp"
#include "tests/unit/host_mesh/support.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fcntl.h>
#include <string>
#include <sys/stat.h>
#include <thread>
#include <vector>

/// Formats as programs and public data sets write them: one cube in every variant, and files of
/// other kinds.
namespace tactus::test
{
namespace
{

using namespace std::string_literals;

/// One line for each vertex of a cube of edge 2, with `tail` after its numbers.
std::string cube_lines(const std::string& head, const std::string& tail = "", double scale = 1.0)
{
    std::string text;
    for (int v = 0; v < 8; ++v)
    {
        text += fmt::format("{}{} {} {}{}\n", head, 2.0 * scale * (v & 1), scale * (v & 2),
                            scale * (v & 4) / 2.0, tail);
    }
    return text;
}

constexpr std::array<std::array<int, 4>, 6> kQuads{
    {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};

/// One line for each face: `form` has four places for its corners, which count from `first`.
std::string quad_lines(const std::string& form, int first = 0)
{
    std::string text;
    for (const auto& [a, b, c, d] : kQuads)
    {
        text += fmt::format(fmt::runtime(form), a + first, b + first, c + first, d + first);
    }
    return text;
}

std::string with_line_ends(const std::string& text, const std::string& end)
{
    std::string other;
    for (const char c : text)
    {
        other += c == '\n' ? end : std::string(1, c);
    }
    return other;
}

std::string in_capitals(std::string text)
{
    std::ranges::transform(text, text.begin(),
                           [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return text;
}

struct Dialect
{
    std::string name; ///< Name with extension.
    std::string bytes;
    std::size_t notes{0};
};

void expect_cube(const Dialect& dialect)
{
    const auto sut = read_bytes(dialect.name, dialect.bytes);
    ASSERT_TRUE(sut) << sut.error().text;
    const TriangleMesh& mesh = sut.value().mesh;
    EXPECT_EQ(mesh.faces.size(), 12U) << dialect.name;
    EXPECT_EQ(signed_volume(mesh), 8.0) << dialect.name;
    EXPECT_EQ(sut.value().notes.size(), dialect.notes)
        << dialect.name << (sut.value().notes.empty() ? "" : ": " + sut.value().notes.front());
}

std::vector<Dialect> off_dialects()
{
    const std::string faces = quad_lines("4 {} {} {} {}\n");
    const std::string body = cube_lines("") + faces;
    std::string one_number_a_line = cube_lines("");
    std::ranges::replace(one_number_a_line, ' ', '\n');
    return {
        {"plain.off", "OFF\n8 6 12\n" + body},
        {"glued.off", "OFF8 6 12\n" + body},
        {"glued_dos.off", with_line_ends("OFF8 6 12\n" + body, "\r\n")},
        {"old_mac.off", with_line_ends("OFF\n8 6 12\n" + body, "\r")},
        {"one_line_of_counts.off", "OFF 8 6 12\n" + body},
        {"no_keyword.off", "8 6 12\n" + body},
        {"comment_and_no_keyword.off", "# a cube\n\n8 6 12\n" + body},
        {"small_letters.off", "off\n8 6 12\n" + body},
        {"two_counts.off", "OFF\n8 6\n" + body},
        {"a_count_a_line.off", "OFF\n8\n6\n12\n" + body},
        {"colours.off", "COFF\n8 6 12\n" + cube_lines("", " 255 0 0 255") + faces},
        {"normals.off", "NOFF\n8 6 12\n" + cube_lines("", " 0 0 1") + faces},
        {"normals_and_colours.off", "CNOFF 8 6 12\n" + cube_lines("", " 0 0 1 1 0 0 1") + faces},
        {"places.off", "STOFF\n8 6 12\n" + cube_lines("", " 0.5 0.5") + faces},
        {"all.off", "STCNOFF\n8 6 12\n" + cube_lines("", " 0 0 1 1 0 0 1 0.5 0.5") + faces},
        {"face_colours.off",
         "OFF\n8 6 12\n" + cube_lines("") + quad_lines("4 {} {} {} {} 0.2 1 0\n")},
        {"vertices_over_lines.off", "OFF\n8 6 12\n" + one_number_a_line + faces},
        {"faces_over_lines.off", "OFF\n8 6 12\n" + cube_lines("") + quad_lines("4 {} {}\n{} {}\n")},
        {"whole_numbers_with_decimals.off",
         "OFF\n8.0 6.0 12.0\n" + cube_lines("") + quad_lines("4 {}.0 {}.0 {}.0 {}.0\n")},
        {"behind.off", "OFF\n8 6 12\n" + body + "0 0\n", 1},
        {"padded.off", "OFF\n8 6 12\n" + body + std::string(40, '\0'), 2},
        {"mark.off", "\xEF\xBB\xBFOFF\n8 6 12\n" + body},
        {"comments.off", "# a\n\nOFF # b\n# c\n 8 6 12 # d\n\n" + cube_lines("", " # e") + "# f\n" +
                             quad_lines("4 {} {} {} {}#g\n\n")},
    };
}

std::vector<Dialect> obj_dialects()
{
    const std::string vertices = cube_lines("v ");
    const std::string faces = quad_lines("f {} {} {} {}\n", 1);
    return {
        {"plain.obj", vertices + faces},
        {"old_mac.obj", with_line_ends(vertices + faces, "\r")},
        {"capitals.obj", in_capitals(vertices + "VN 0 0 1\n" + faces)},
        {"continued.obj", vertices + quad_lines("f {} {} \\\n {} {}\n", 1)},
        {"continued_and_glued.obj", vertices + quad_lines("f {} {}\\\n{} {}\n", 1)},
        {"continued_often.obj", vertices + quad_lines("f {}\\\n\\\n {}\\\n{} {}\n", 1)},
        {"continued_behind_a_blank.obj", vertices + quad_lines("f {} {} \\ \n {} {}\n", 1)},
        {"continued_and_dos.obj",
         with_line_ends(vertices + quad_lines("f {} {}\\\n{} {}\n", 1), "\r\n")},
        {"continued_corners.obj",
         vertices + "vt 0 0\nvn 0 0 1\n" + quad_lines("f {}/1/1 {}/1/1\\\n{}/1/1 {}/1/1\n", 1)},
        {"continued_vertices.obj", with_line_ends(cube_lines("v ", "\\"), "\n 1\n") + faces},
        {"continued_normals.obj", vertices + "vn 0 0\\\n1\nvt 0 \\\n 0\nl 1 2\\\n3\n" + faces, 1},
        {"backslash_in_names.obj",
         "# C:\\a\\\nmtllib C:\\b\\\ng C:\\c\\\n#x\\\n" + vertices + faces},
        {"relative.obj", vertices + quad_lines("f {} {} {} {}\n", -8) + "v 9 9 9\n"},
        {"mark.obj", "\xEF\xBB\xBF" + vertices + faces},
        {"places_of_pictures.obj", "mtllib x.mtl\no thing\ng a b\ns off\nusemtl red\nvt 0 0\n" +
                                       vertices +
                                       quad_lines("f {}/1 {}/1 {}/1 {}/1 # a face\n", 1)},
        {"colours.obj", cube_lines("v ", " 0.5 0.25 1") + faces},
        {"weight_1.obj", cube_lines("v ", " 1.0") + faces},
        {"weight_2.obj", cube_lines("v ", " 2.0", 2.0) + faces, 1},
        {"weight_and_colours.obj", cube_lines("v ", " 2 0.5 0.5 0.5", 2.0) + faces, 1},
        {"no_normals.obj", vertices + "vn 0 0 1\n" + quad_lines("f {}//1 {}//1 {}//1 {}//1\n", 1)},
        {"faces_first.obj", faces + vertices},
        {"points_and_lines.obj", vertices + "p 1\nl 1 2 3\nsurf 0 1 0 1 1 2\n" + faces, 1},
        {"tabs.obj",
         with_line_ends(cube_lines("v\t", "\t"), " \n") + quad_lines("f\t{}\t{}\t{}\t{}  \n", 1)},
        {"closed_polygons.obj",
         vertices +
             "f 1 3 4 2 1\nf 5 6 8 7 5\nf 1 2 6 5 1\nf 3 7 8 4 3\nf 1 5 7 3 1\nf 2 4 8 6 2\n"},
        {"two_corners.obj", vertices + "f 1 2\n" + faces, 1},
        {"fortran.obj", "v 2D0 0 0\n" + vertices + quad_lines("f {} {} {} {}\n", 2)},
        {"padded.obj", vertices + faces + std::string(100, '\0'), 2},
    };
}

std::vector<Dialect> ply_dialects()
{
    const std::string start = "ply\nformat ascii 1.0\n";
    const std::string vertex =
        "element vertex 8\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string list = "property list uchar int vertex_indices\n";
    const std::string body = cube_lines("") + quad_lines("4 {} {} {} {}\n");
    const std::string whole = start + vertex + "element face 6\n" + list + "end_header\n" + body;
    std::string capital_names = whole;
    for (const char axis : {'x', 'y', 'z'})
    {
        const auto at = capital_names.find("float "s + axis);
        capital_names[at + 6] = static_cast<char>(axis - 32);
    }
    std::string capital_header = whole;
    std::transform(capital_header.begin(),
                   capital_header.begin() +
                       static_cast<std::ptrdiff_t>(capital_header.find("end_header") + 10),
                   capital_header.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 32) : c; });
    const auto named = [&](const std::string& name)
    {
        std::string text = whole;
        return text.replace(text.find("vertex_indices"), 14, name);
    };
    return {
        {"plain.ply", whole},
        {"dos.ply", with_line_ends(whole, "\r\n")},
        {"mark.ply", "\xEF\xBB\xBF" + whole},
        {"old_mac.ply", with_line_ends(whole, "\r")},
        {"capital_names.ply", capital_names},
        {"capital_header.ply", capital_header},
        {"vertex_index.ply", named("vertex_index")},
        {"vertex_indexes.ply", named("vertex_indexes")},
        {"another_name.ply", named("corners"), 1},
        {"material_first.ply", start + vertex + "element face 6\nproperty uchar material\n" + list +
                                   "end_header\n" + cube_lines("") +
                                   quad_lines("7 4 {} {} {} {}\n")},
        {"places_of_pictures.ply", start + vertex +
                                       "element face 6\nproperty list uchar float texcoord\n" +
                                       list + "property int flags\nend_header\n" + cube_lines("") +
                                       quad_lines("2 0.5 1 4 {} {} {} {} 3\n")},
        {"edges_between.ply", start + vertex +
                                  "element edge 1\nproperty int vertex1\nproperty int vertex2\n"
                                  "element face 6\n" +
                                  list + "end_header\n" + cube_lines("") + "0 1\n" +
                                  quad_lines("4 {} {} {} {}\n")},
        {"blanks.ply", with_line_ends(whole, "  \n")},
        {"behind.ply", whole + "4 0 1 2 3\n", 1},
        {"padded.ply", whole + std::string(7, '\0'), 2},
    };
}

/// Binary PLY whose data begin with a line feed, which does not belong to the header if lines end
/// in CR.
std::string binary_ply(const std::string& line_end)
{
    std::string bytes =
        with_line_ends("ply\nformat binary_little_endian 1.0\nelement thing 1\nproperty uchar "
                       "t\nelement vertex 8\n"
                       "property float x\nproperty float y\nproperty float z\nelement face 6\n"
                       "property list uchar uchar vertex_indices\nend_header\n",
                       line_end);
    bytes += '\n';
    for (int v = 0; v < 8; ++v)
    {
        for (const float c : {2.0F * static_cast<float>(v & 1), static_cast<float>(v & 2),
                              static_cast<float>(v & 4) / 2.0F})
        {
            append(bytes, c);
        }
    }
    for (const auto& quad : kQuads)
    {
        bytes += '\x04';
        for (const int corner : quad)
        {
            bytes += static_cast<char>(corner);
        }
    }
    return bytes;
}

TriangleMesh cube_mesh()
{
    const auto file =
        read_bytes("cube.off", "OFF\n8 6 12\n" + cube_lines("") + quad_lines("4 {} {} {} {}\n"));
    return file.value().mesh;
}

std::vector<Dialect> stl_dialects()
{
    const TriangleMesh cube = cube_mesh();
    const std::string text = as_ascii_stl(cube);
    const std::string binary = as_binary_stl(cube, "any");
    std::string one_line = text;
    std::ranges::replace(one_line, '\n', ' ');
    const auto named = [&](const std::string& name)
    {
        std::string other = text;
        return other.replace(0, 13, "solid" + name);
    };
    std::string two_words = text;
    for (const auto* word : {"endloop", "endfacet", "endsolid"})
    {
        for (auto at = two_words.find(word); at != std::string::npos; at = two_words.find(word, at))
        {
            two_words.insert(at + 3, " ");
        }
    }
    std::string no_normals = text;
    for (auto at = no_normals.find(" normal"); at != std::string::npos;
         at = no_normals.find(" normal"))
    {
        no_normals.erase(at, no_normals.find('\n', at) - at);
    }
    return {
        {"text.stl", text},
        {"binary.stl", binary},
        {"binary_solid.stl", as_binary_stl(cube, "solid cube")},
        {"old_mac.stl", with_line_ends(text, "\r")},
        {"dos.stl", with_line_ends(text, "\r\n")},
        {"capitals.stl", in_capitals(text)},
        {"mark.stl", "\xEF\xBB\xBF" + text},
        {"blank_first.stl", "\n  " + text},
        {"one_line.stl", one_line},
        {"no_name.stl", named("")},
        {"name_of_words.stl", named(" facet normal 1")},
        {"latin_name.stl", named(" K\xF6rper")},
        {"name_of_two_lines.stl", named(" thing\n; made by a slicer"), 1},
        {"two_words.stl", two_words},
        {"no_normals.stl", no_normals},
        {"behind_text.stl", text + "made by hand\n", 1},
        {"padded_text.stl", text + std::string(100, '\0'), 1},
        {"byte_behind.stl", binary + "\n", 1},
        {"byte_behind_solid.stl", as_binary_stl(cube, "solid cube") + "\n", 1},
        {"padded.stl", binary + std::string(340, '\0'), 1},
        {"padded_like_triangles.stl", binary + std::string(100, '\0'), 1},
        {"padded_like_a_header.stl", binary + std::string(84, '\0'), 1},
    };
}

TEST(Dialects, of_every_format_give_the_same_cube)
{
    for (const auto& dialects : {off_dialects(), obj_dialects(), ply_dialects(), stl_dialects()})
    {
        for (const Dialect& dialect : dialects)
        {
            expect_cube(dialect);
        }
    }
    for (const std::string end : {"\n", "\r\n", "\r"})
    {
        expect_cube({"binary.ply", binary_ply(end)});
    }
    expect_cube({"behind_binary.ply", binary_ply("\n") + "x", 1});
}

TEST(Dialects, of_several_solids_in_one_file_give_all_of_them)
{
    const std::string text = as_ascii_stl(cube_mesh());
    std::string one_line = text + text;
    std::ranges::replace(one_line, '\n', ' ');
    const std::string binary = as_binary_stl(cube_mesh(), "any");
    for (const std::string& bytes : {text + text, one_line, binary + binary})
    {
        const auto sut = read_bytes("two.stl", bytes);
        ASSERT_TRUE(sut) << sut.error().text;
        EXPECT_EQ(sut.value().mesh.faces.size(), 24U);
    }
}

struct Foreign
{
    std::string bytes;
    std::string words;
};

std::string utf16(const std::string& text, bool big_endian, const std::string& mark)
{
    std::string bytes = mark;
    for (const char c : text)
    {
        bytes += big_endian ? "\0"s + c : c + "\0"s;
    }
    return bytes;
}

TEST(ForeignFiles, are_called_what_they_are_in_every_format)
{
    const std::string cube = "solid cube\nfacet normal 0 0 1\nouter loop\n";
    const std::vector<Foreign> files{
        {"<!DOCTYPE html><html><body>404</body></html>" + std::string(200, ' '), "HTML"},
        {"\n  <HTML>\n<head>", "HTML"},
        {"<?xml version=\"1.0\"?>\n<COLLADA>", "XML"},
        {"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a2146\nsize 12345\n",
         "Git LFS pointer"},
        {utf16(cube, false, "\xFF\xFE"), "UTF-16"},
        {utf16(cube, true, "\xFE\xFF"), "UTF-16"},
        {utf16(cube, false, ""), "UTF-16"},
        {"\x1F\x8B\x08\x00 some bytes"s, "gzip"},
        {"PK\x03\x04 some bytes"s, "ZIP"},
        {"glTF\x02\0\0\0"s, ".glb"},
        {"{\"asset\": {\"version\": \"2.0\"}}", ".gltf"},
        {"\x89PNG\r\n\x1A\n some bytes"s, "picture"},
        {"TACTSPM\n some bytes", "a model already"},
    };
    for (const std::string name : {"a.ply", "a.obj", "a.stl", "a.off"})
    {
        for (const Foreign& file : files)
        {
            const std::string text = refusal(read_bytes(name, file.bytes));
            EXPECT_NE(text.find(file.words), std::string::npos) << name << ": " << text;
        }
    }
    EXPECT_NE(refusal(read_bytes("a.stl", as_obj(cube_mesh()).substr(10))).find("--format obj"),
              std::string::npos);
    EXPECT_NE(refusal(read_bytes("a.mesh", as_off(cube_mesh()))).find("--format off"),
              std::string::npos);
    EXPECT_NE(refusal(read_bytes("a.ply.gz", "\x1F\x8B bytes")).find("gzip"), std::string::npos);
    EXPECT_NE(refusal(read_bytes("a.obj", as_ascii_ply(cube_mesh()))).find("--format ply"),
              std::string::npos);
    EXPECT_NE(refusal(read_bytes("a.stl", "hello world\n")).find("is a text that begins with"),
              std::string::npos);
}

TEST(ForeignFiles, that_are_broken_are_refused_by_what_is_wrong)
{
    const std::string off = "8 6 12\n" + cube_lines("") + quad_lines("4 {} {} {} {}\n");
    const std::string binary = as_binary_stl(cube_mesh(), "any");
    std::string forgotten = binary;
    forgotten[80] = 11;
    std::string none = binary;
    none[80] = 0;
    std::string comma = as_ascii_stl(cube_mesh());
    comma.replace(comma.find("vertex 0"), 8, "vertex 0,5");
    const std::string ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                            "property float y\nproperty float z\nelement face 1\n";
    for (
        const auto& [name, bytes, words] : std::vector<std::array<std::string, 3>>{
            {"a.off", "4OFF\n" + off, "other than three coordinates"},
            {"a.off", "nOFF\n3\n" + off, "other than three coordinates"},
            {"a.off", "OFF BINARY\n" + off, "binary OFF"},
            {"a.off", "XOFF\n" + off, "starts with 'XOFF'"},
            {"a.stl", binary.substr(0, binary.size() - 30), "declares 12 triangles"},
            {"a.stl", forgotten, "has room for 1 more"},
            {"a.stl", none, "declares 0 triangles"},
            {"a.stl", comma, "point, not a comma"},
            {"a.ply",
             ply + "property int v1\nproperty int v2\nproperty int v3\nend_header\n0 0 0\n1 0 0\n"
                   "0 1 0\n0 1 2\n",
             "their properties: 'v1', 'v2', 'v3'"},
            {"a.ply",
             ply +
                 "property list uchar int vertex_indices\nend_header\n0 0 0,5\n1 0 0\n0 1 0\n3 0 1 "
                 "2\n",
             "vertex 0 of 3 (from 0): 'z' is '0,5', not a number; decimals must have a point"},
            {"a.ply",
             ply +
                 "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n",
             "the file ends at 'vertex_indices'"},
            {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", "names no vertex"}})
    {
        const std::string text = refusal(read_bytes(name, bytes));
        EXPECT_NE(text.find(words), std::string::npos) << text;
    }
}

TEST(ReadMesh, takes_any_name_and_pipes_with_a_format)
{
    const TemporaryFolder directory;
    const std::string bytes = as_obj(cube_mesh());
    const auto odd = directory.write("cube.txt", bytes);
    EXPECT_FALSE(read_mesh_file(odd));
    const auto named = read_mesh_file(odd, MeshFormat::obj);
    ASSERT_TRUE(named) << named.error().text;
    EXPECT_EQ(named.value().mesh.faces.size(), 12U);

    const auto pipe = directory.path() / "pipe";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    std::thread writer([&] { std::ofstream(pipe, std::ios::binary) << bytes; });
    const auto piped = read_mesh_file(pipe, MeshFormat::obj);
    writer.join();
    ASSERT_TRUE(piped) << piped.error().text;
    EXPECT_EQ(corners_of(piped.value().mesh), corners_of(named.value().mesh));
    EXPECT_FALSE(read_mesh_file("/dev/null", MeshFormat::obj));
}

TEST(ReadMesh, knows_its_formats_by_name)
{
    for (const MeshFormat format :
         {MeshFormat::ply, MeshFormat::obj, MeshFormat::stl, MeshFormat::off})
    {
        EXPECT_EQ(mesh_format(format_name(format)), format);
    }
    EXPECT_EQ(mesh_format("PLY"), MeshFormat::ply);
    EXPECT_FALSE(mesh_format("glb"));
    EXPECT_FALSE(mesh_format(""));
}

} // namespace
} // namespace tactus::test
