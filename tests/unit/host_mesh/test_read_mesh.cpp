// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/read_mesh.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "tests/unit/host_mesh/samples.hpp"
#include "tests/unit/host_mesh/support.hpp"

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <ostream>
#include <string>
#include <sys/stat.h>

/// Our readers against Assimp's, in its single precision, and against known facts of well-known
/// meshes.
namespace tactus::test
{
namespace
{

bool contains(const std::string& text, std::string_view part)
{
    return text.find(part) != std::string::npos;
}

std::string replaced(std::string text, std::string_view from, std::string_view to)
{
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

TriangleMesh with_float_positions(TriangleMesh mesh)
{
    for (auto& p : mesh.positions)
    {
        for (double& c : p)
        {
            c = static_cast<double>(static_cast<float>(c));
        }
    }
    return mesh;
}

TEST(ReadMesh, returns_the_same_faces_from_every_format)
{
    const auto mesh = tetrahedron();
    for (const auto& [name, bytes] : in_all_formats(mesh))
    {
        const bool is_float = name == "binary.stl" || name == "solid.stl";
        const auto sut = read_bytes(name, bytes);
        ASSERT_TRUE(sut) << sut.error().text;
        EXPECT_EQ(corners_of(sut.value().mesh),
                  corners_of(is_float ? with_float_positions(mesh) : mesh))
            << name;
        if (!contains(name, ".stl")) // Indexed formats keep the order.
        {
            EXPECT_EQ(sut.value().mesh.positions, mesh.positions) << name;
            EXPECT_EQ(sut.value().mesh.faces, mesh.faces) << name;
        }
        EXPECT_TRUE(sut.value().notes.empty()) << name << ": " << sut.value().notes.front();
    }
}

/// The oracle is the format: a truncated file gives an error, or nothing is missing, or a note
/// reports the possibility. OBJ truncated at a line end is a complete shorter file.
TEST(ReadMesh, never_takes_a_cut_file_for_a_smaller_mesh)
{
    const auto mesh = tetrahedron();
    const TemporaryFolder directory;
    for (const auto& [name, bytes] : in_all_formats(mesh))
    {
        const auto whole = read_bytes(name, bytes);
        ASSERT_TRUE(whole);
        std::size_t refused = 0;
        for (std::size_t length = 0; length < bytes.size(); ++length)
        {
            const auto part = std::string_view(bytes).substr(0, length);
            const auto sut = read_mesh_file(directory.write(name, part));
            const bool at_line_end = length > 0 && bytes[length - 1] == '\n';
            if (!sut)
            {
                ++refused;
                continue;
            }
            const bool is_whole = sut.value().mesh.faces == whole.value().mesh.faces &&
                                  sut.value().mesh.positions == whole.value().mesh.positions;
            EXPECT_TRUE(is_whole || !sut.value().notes.empty() ||
                        (name == "text.obj" && at_line_end))
                << name << " cut at " << length;
        }
        EXPECT_GT(refused, bytes.size() / 2) << name;
    }
}

TEST(ReadMesh, refuses_what_is_not_a_file)
{
    const TemporaryFolder directory;
    EXPECT_TRUE(contains(refusal(read_mesh_file(directory.path() / "no.obj")), "no such file"));
    EXPECT_TRUE(contains(refusal(read_mesh_file(directory.path())), "is a directory"));
    const auto pipe = directory.path() / "pipe.obj";
    ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
    EXPECT_TRUE(contains(refusal(read_mesh_file(pipe)), "not a regular file"));
    EXPECT_TRUE(contains(refusal(read_mesh_file("")), "no such file"));
}

TEST(ReadMesh, refuses_an_unknown_extension_and_takes_capital_ones)
{
    EXPECT_TRUE(contains(refusal(read_bytes("a.xyz", "x")), ".ply, .obj, .stl or .off"));
    EXPECT_TRUE(contains(refusal(read_bytes("noextension", "x")), "unknown kind"));
    EXPECT_TRUE(read_bytes("A.OBJ", as_obj(tetrahedron())));
}

TEST(ReadMesh, refuses_empty_files_and_prose_in_every_format)
{
    for (const std::string name : {"a.ply", "a.obj", "a.stl", "a.off"})
    {
        EXPECT_TRUE(contains(refusal(read_bytes(name, "")), "is empty")) << name;
        EXPECT_TRUE(contains(refusal(read_bytes(name, "hello world, how are you\n")), name));
        EXPECT_FALSE(refusal(read_bytes(name, std::string(1000, '\0'))).empty());
        EXPECT_FALSE(refusal(read_bytes(name, std::string(1000, '\xFF'))).empty());
    }
}

TEST(ReadMesh, refuses_coordinates_that_are_not_finite)
{
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
          -std::numeric_limits<double>::infinity()})
    {
        auto mesh = tetrahedron();
        mesh.positions[2][1] = bad;
        for (const auto& [name, bytes] : in_all_formats(mesh))
        {
            EXPECT_TRUE(contains(refusal(read_bytes(name, bytes)), "must be finite"))
                << name << ' ' << bad;
        }
    }
    const std::string huge = replaced(as_obj(tetrahedron()), "v 1 0 0", "v 1 -1e999 0");
    EXPECT_TRUE(contains(refusal(read_bytes("a.obj", huge)), "vertex 1 (from 0): y is inf"));
}

TEST(ReadMesh, takes_numbers_too_small_for_a_double_as_zero)
{
    const auto sut = read_bytes("a.obj", "v 1e-999 0 0\nv +1 0 0\nv 0 1 0\nf 1 2 3\n");
    ASSERT_TRUE(sut) << sut.error().text;
    EXPECT_EQ(sut.value().mesh.positions[0][0], 0.0);
    EXPECT_EQ(sut.value().mesh.positions[1][0], 1.0);
}

TEST(ReadMesh, refuses_an_index_out_of_range_and_says_where)
{
    auto mesh = tetrahedron();
    mesh.faces[3] = {0, 1, 99};
    EXPECT_TRUE(contains(refusal(read_bytes("a.obj", as_obj(mesh))),
                         "line 9: vertex index 100 is out of range; the file has 4 vertices"));
    EXPECT_TRUE(contains(refusal(read_bytes("a.off", as_off(mesh))),
                         "line 10: face 3 of 4: vertex index '99' is not in 0..3"));
    EXPECT_TRUE(contains(refusal(read_bytes("a.ply", as_ascii_ply(mesh))),
                         "line 18: face 3 of 4 (from 0): vertex index 99 is not in 0..3"));
    for (const bool big : {false, true})
    {
        EXPECT_TRUE(contains(refusal(read_bytes("a.ply", as_binary_ply(mesh, big))),
                             "face 3 of 4 (from 0): vertex index 99 is not in 0..3"));
    }
    EXPECT_TRUE(contains(refusal(read_bytes("a.obj", as_obj(tetrahedron()) + "f 0 1 2\n")),
                         "'0' names no vertex"));
    EXPECT_TRUE(contains(refusal(read_bytes("a.obj", as_obj(tetrahedron()) + "f -5 1 2\n")),
                         "'-5' names no vertex"));
    EXPECT_TRUE(contains(
        refusal(read_bytes("a.ply", replaced(as_ascii_ply(tetrahedron()), "3 0 2 1", "3 0 2 -1"))),
        "vertex index -1"));
}

TEST(ReadMesh, refuses_a_file_without_faces)
{
    auto mesh = tetrahedron();
    mesh.faces.clear();
    for (const auto& [name, bytes] : in_all_formats(mesh))
    {
        EXPECT_TRUE(contains(refusal(read_bytes(name, bytes)), "holds no faces")) << name;
    }
}

TEST(ReadMesh, refuses_counts_that_the_file_is_too_small_for)
{
    for (const std::string count : {"500000000", "4294967295", "9000000000000000000"})
    {
        for (const auto& [name, bytes] : in_all_formats(tetrahedron()))
        {
            if (contains(name, ".ply"))
            {
                const auto vertices = replaced(bytes, "vertex 4", "vertex " + count);
                EXPECT_TRUE(contains(refusal(read_bytes(name, vertices)), "are left")) << name;
                const auto faces = replaced(bytes, "face 4", "face " + count);
                EXPECT_TRUE(contains(refusal(read_bytes(name, faces)), "are left")) << name;
            }
            if (contains(name, ".off"))
            {
                const auto vertices = replaced(bytes, "4 4 0", count + " 4 0");
                EXPECT_TRUE(contains(refusal(read_bytes(name, vertices)), "bytes follow"));
                const auto faces = replaced(bytes, "4 4 0", "4 " + count + " 0");
                EXPECT_TRUE(contains(refusal(read_bytes(name, faces)), "bytes follow"));
            }
        }
    }
    std::string stl = as_binary_stl(tetrahedron(), "any");
    stl[83] = '\x7F';
    EXPECT_TRUE(contains(refusal(read_bytes("a.stl", stl)), "declares"));
}

TEST(ReadMesh, shows_no_byte_of_the_file_that_a_terminal_would_obey)
{
    const std::string start = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n"
                              "property float y\nproperty float z\nproperty float \x1b[2J\n"
                              "element fa\x07\x1b]0;ce 1\nproperty list int int \xff\n"
                              "end_header\n";
    for (const std::string body : {"", "0 0 0 0\n", "0 0 0 no\n1 0\n", "0 0 0 0\n-1 0\n",
                                   "0 0 0 0\n1 no\n", "0 0 0 0\n9 0\n"})
    {
        const std::string text = refusal(read_bytes("a.ply", start + body));
        EXPECT_FALSE(text.empty()) << body;
        EXPECT_TRUE(std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; })) << body;
    }
}

using FloatCorners = std::vector<std::array<std::array<float, 3>, 3>>;

FloatCorners read_by_assimp(const std::filesystem::path& path)
{
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path.string(), aiProcess_Triangulate);
    FloatCorners corners;
    for (unsigned m = 0; scene != nullptr && m < scene->mNumMeshes; ++m)
    {
        const aiMesh& mesh = *scene->mMeshes[m];
        for (unsigned f = 0; f < mesh.mNumFaces; ++f)
        {
            auto& face = corners.emplace_back();
            for (unsigned k = 0; k < 3; ++k)
            {
                const aiVector3D& p = mesh.mVertices[mesh.mFaces[f].mIndices[k]];
                face[k] = {p.x, p.y, p.z};
            }
        }
    }
    return corners;
}

/// Assimp's number parser has errors of a few units in the last place.
void expect_same_corners(const std::filesystem::path& path)
{
    const auto sut = read_mesh(path);
    ASSERT_TRUE(sut) << sut.error().text;
    const auto ours = corners_of(sut.value());
    const auto theirs = read_by_assimp(path);
    ASSERT_EQ(ours.size(), theirs.size()) << path;
    for (std::size_t f = 0; f < ours.size(); ++f)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                const double x = ours[f][k][axis];
                ASSERT_NEAR(x, static_cast<double>(theirs[f][k][axis]), 1e-6 * std::abs(x) + 1e-12)
                    << path << " face " << f;
            }
        }
    }
}

TEST(SecondOpinion, assimp_reads_the_same_generated_files)
{
    const auto mesh = make_shape(Shape::bumpy_sphere, 2000);
    ASSERT_TRUE(mesh);
    const TemporaryFolder directory;
    for (const auto& [name, bytes] : in_all_formats(mesh.value()))
    {
        expect_same_corners(directory.write(name, bytes));
    }
}

std::filesystem::path known_mesh(const std::string& name)
{
    const char* folder = std::getenv("TACTUS_MESHES");
    return folder == nullptr ? std::filesystem::path{} : std::filesystem::path(folder) / name;
}

struct KnownMesh
{
    std::string name;
    std::size_t vertices;
    std::size_t faces;
    bool in_assimp; ///< Assimp does not read triangle strips.

    friend std::ostream& operator<<(std::ostream& out, const KnownMesh& mesh)
    {
        return out << mesh.name;
    }
};

using KnownMeshes = testing::TestWithParam<KnownMesh>;

TEST_P(KnownMeshes, are_read_whole_and_become_manifold)
{
    const auto& known = GetParam();
    const auto path = known_mesh(known.name);
    if (path.empty())
    {
        GTEST_SKIP() << "TACTUS_MESHES is not set";
    }
    const auto file = read_mesh_file(path);
    ASSERT_TRUE(file) << file.error().text;
    EXPECT_EQ(file.value().mesh.positions.size(), known.vertices);
    EXPECT_EQ(file.value().mesh.faces.size(), known.faces);
    if (known.in_assimp)
    {
        expect_same_corners(path);
    }
    const auto sut = prepare_mesh(file.value().mesh, {.fit_diagonal_m = 0.1});
    ASSERT_TRUE(sut) << sut.error().text;
    EXPECT_TRUE(is_manifold_with_borders(sut.value().mesh));
    for (const auto& note : sut.value().notes)
    {
        std::cout << known.name << ": " << note << '\n';
    }
}

std::string name_of_known(const testing::TestParamInfo<KnownMesh>& known)
{
    const std::string stem = std::filesystem::path(known.param.name).stem().string();
    return stem.substr(stem.find('-') + 1);
}

INSTANTIATE_TEST_SUITE_P(WellKnown, KnownMeshes,
                         testing::Values(KnownMesh{"igea.ply", 134345, 268686, false},
                                         KnownMesh{"stanford-bunny.obj", 35947, 69451, true},
                                         KnownMesh{"cow.obj", 2903, 5804, true},
                                         KnownMesh{"fandisk.obj", 6475, 12946, true},
                                         KnownMesh{"teapot.obj", 3644, 6320, true}),
                         name_of_known);

TEST(SecondOpinion, igea_is_closed_manifold_and_turned_outward)
{
    const auto path = known_mesh("igea.ply");
    if (path.empty())
    {
        GTEST_SKIP() << "TACTUS_MESHES is not set";
    }
    const auto sut = read_mesh(path);
    ASSERT_TRUE(sut) << sut.error().text;
    const auto& mesh = sut.value();
    EXPECT_TRUE(is_manifold_with_borders(mesh.faces, mesh.positions.size()));
    EXPECT_EQ(border_edges(mesh.faces), 0U);
    EXPECT_GT(signed_volume(mesh), 0.0);
}

} // namespace
} // namespace tactus::test
