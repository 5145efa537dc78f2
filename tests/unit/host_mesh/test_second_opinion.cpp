// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/shapes/shapes.hpp"
#include "tests/unit/host_mesh/samples.hpp"
#include "tests/unit/host_mesh/support.hpp"

#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <ostream>

/// Our readers against Assimp's, in its single precision, and against known facts of well-known
/// meshes.

namespace tactus::test
{
namespace
{

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
