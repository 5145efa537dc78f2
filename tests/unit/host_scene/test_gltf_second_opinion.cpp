// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/scene.hpp"

#include <Eigen/Geometry>
#include <assimp/Importer.hpp>
#include <assimp/scene.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <ostream>
#include <string>
#include <vector>

/// Samples of Debian's package assimp-testmodels, valid and broken: valid ones must equal Assimp's
/// result, triangle by triangle in the world; broken ones are refused, even if Assimp accepts them.

namespace tactus::test
{
namespace
{

using Eigen::Vector3d;
using Triangle = std::array<Vector3d, 3>;

std::filesystem::path sample(const std::string& name)
{
    return std::filesystem::path("/usr/share/assimp/models/glTF2") / name;
}

/// The file's JSON, without further interpretation.
nlohmann::json json_of(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    if (path.extension() == ".glb")
    {
        text = text.substr(20, text.find(std::string("BIN\0", 4)) - 4 - 20);
    }
    return nlohmann::json::parse(text);
}

/// Nodes with a mesh, depth first, in Assimp's order.
std::vector<std::size_t> mesh_nodes(const nlohmann::json& document)
{
    std::vector<std::size_t> found;
    const std::function<void(std::size_t)> visit = [&](std::size_t node)
    {
        const auto& value = document["nodes"][node];
        if (value.contains("mesh"))
        {
            found.push_back(node);
        }
        for (const auto& child : value.value("children", nlohmann::json::array()))
        {
            visit(child.get<std::size_t>());
        }
    };
    for (const auto& root : document["scenes"][document.value("scene", 0U)]["nodes"])
    {
        visit(root.get<std::size_t>());
    }
    return found;
}

/// Triangles in the world, node by node, depth first.
void gather(const aiScene& scene, const aiNode& node, const aiMatrix4x4& parent,
            std::vector<std::vector<Triangle>>& nodes)
{
    const aiMatrix4x4 world = parent * node.mTransformation;
    if (node.mNumMeshes > 0)
    {
        auto& triangles = nodes.emplace_back();
        for (unsigned m = 0; m < node.mNumMeshes; ++m)
        {
            const aiMesh& mesh = *scene.mMeshes[node.mMeshes[m]];
            for (unsigned f = 0; f < mesh.mNumFaces; ++f)
            {
                auto& triangle = triangles.emplace_back();
                for (unsigned k = 0; k < 3; ++k)
                {
                    const aiVector3D p = world * mesh.mVertices[mesh.mFaces[f].mIndices[k]];
                    triangle[k] = {static_cast<double>(p.x), static_cast<double>(p.y),
                                   static_cast<double>(p.z)};
                }
            }
        }
    }
    for (unsigned i = 0; i < node.mNumChildren; ++i)
    {
        gather(scene, *node.mChildren[i], world, nodes);
    }
}

std::vector<Triangle> triangles_of(Scene& scene, const SceneObject& object)
{
    const auto mesh = scene.read_mesh(object.mesh.value());
    std::vector<Triangle> triangles;
    if (!mesh)
    {
        ADD_FAILURE() << mesh.error().text;
        return triangles;
    }
    const auto& [x, y, z, w] = object.pose.rotation;
    const Eigen::Matrix3d linear =
        object.pose.scale * Eigen::Quaterniond(w, x, y, z).toRotationMatrix();
    for (const auto& face : mesh.value().mesh.faces)
    {
        auto& triangle = triangles.emplace_back();
        for (std::size_t k = 0; k < 3; ++k)
        {
            triangle[k] = linear * Vector3d(mesh.value().mesh.positions[face[k]].data()) +
                          Vector3d(object.pose.translation_m.data());
        }
    }
    return triangles;
}

/// Least difference over three rotations: a face may begin at any corner, but must keep its
/// orientation.
double difference(const Triangle& ours, const Triangle& theirs)
{
    double least = HUGE_VAL;
    for (std::size_t turn = 0; turn < 3; ++turn)
    {
        double largest = 0.0;
        for (std::size_t k = 0; k < 3; ++k)
        {
            largest = std::max(largest, (ours[k] - theirs[(k + turn) % 3]).norm());
        }
        least = std::min(least, largest);
    }
    return least;
}

struct Sample
{
    std::string name;
    std::string file;
    std::string refusal; ///< Part of the refusal; empty if the file is read.

    friend std::ostream& operator<<(std::ostream& out, const Sample& value)
    {
        return out << value.name;
    }
};

struct SecondOpinion : testing::TestWithParam<Sample>
{
    void SetUp() override
    {
        if (!std::filesystem::exists(sample(GetParam().file)))
        {
            GTEST_SKIP() << "assimp-testmodels is not installed";
        }
    }
};

TEST_P(SecondOpinion, agrees_or_is_refused)
{
    const auto path = sample(GetParam().file);
    auto sut = Scene::open(path);
    std::string refusal = sut ? "" : sut.error().text;
    for (std::size_t i = 0; sut && refusal.empty() && i < sut.value().objects().size(); ++i)
    {
        const auto mesh = sut.value().read_mesh(sut.value().objects()[i].mesh.value());
        refusal = !mesh                             ? mesh.error().text
                  : mesh.value().mesh.faces.empty() ? mesh.value().left_out
                                                    : "";
    }
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(path.string(), 0);
    if (!GetParam().refusal.empty())
    {
        EXPECT_NE(refusal.find(GetParam().refusal), std::string::npos) << refusal;
        std::printf("Assimp %s it\n", scene == nullptr ? "refuses" : "reads");
        return;
    }
    ASSERT_EQ(refusal, "");
    ASSERT_NE(scene, nullptr) << importer.GetErrorString();
    std::vector<std::vector<Triangle>> theirs;
    gather(*scene, *scene->mRootNode, aiMatrix4x4(), theirs);
    const auto order = mesh_nodes(json_of(path));
    ASSERT_EQ(order.size(), theirs.size());
    ASSERT_EQ(order.size(), sut.value().objects().size());
    std::size_t compared = 0;
    for (std::size_t i = 0; i < order.size(); ++i)
    {
        const std::string ending = "nodes[" + std::to_string(order[i]) + "]";
        const auto object =
            std::ranges::find_if(sut.value().objects(), [&](const SceneObject& candidate)
                                 { return candidate.place.find(ending) != std::string::npos; });
        ASSERT_NE(object, sut.value().objects().end()) << ending;
        const auto ours = triangles_of(sut.value(), *object);
        ASSERT_EQ(ours.size(), theirs[i].size()) << object->place;
        for (std::size_t f = 0; f < ours.size(); ++f)
        {
            const double size = ours[f][0].norm() + ours[f][1].norm() + ours[f][2].norm();
            ASSERT_LE(difference(ours[f], theirs[i][f]), 1e-5 * size + 1e-9)
                << object->place << ", face " << f;
            ++compared;
        }
    }
    EXPECT_GT(compared, 0U);
    std::printf("%zu objects, %zu triangles compared\n", order.size(), compared);
}

std::vector<Sample> samples()
{
    const std::string box = "BoxTextured-glTF";
    std::vector<Sample> all{
        {"cylinder_engine", "2CylinderEngine-glTF-Binary/2CylinderEngine.glb", ""},
        {"bad_normals", "BoxBadNormals-glTF-Binary/BoxBadNormals.glb", ""},
        {"texcoords", "BoxTexcoords-glTF/boxTexcoords.gltf", ""},
        {"box", box + "/BoxTextured.gltf", ""},
        {"box_binary", box + "-Binary/BoxTextured.glb", ""},
        {"box_embedded", box + "-Embedded/BoxTextured.gltf", ""},
        {"box_glossy", box + "-pbrSpecularGlossiness/BoxTextured.gltf", ""},
        {"clear_coat", "ClearCoat-glTF/ClearCoatTest.gltf", ""},
        {"cameras", "cameras/Cameras.gltf", ""},
        {"texture_transform", "textureTransform/TextureTransformTest.gltf", ""},
        {"box_webgl", box + "-techniqueWebGL/BoxTextured.gltf", ""},
        {"infinites", "BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb", "x is -inf"},
        {"vertex_arrays", "IncorrectVertexArrays/Cube.gltf", "has 35 corners"},
        {"index_beyond", "IndexOutOfRange/IndexOutOfRange.gltf", "255; there are 24 positions"},
        {"indices_beyond", "IndexOutOfRange/AllIndicesOutOfRange.gltf", "65535; there are 24"},
        {"missing_bin", "MissingBin/BoxTextured.gltf", "'BoxTextured0.bin': no such file"},
        {"recursive", "RecursiveNodes/RecursiveNodes.gltf", "is its own ancestor"},
        {"wrong_type", "SchemaFailures/sceneWrongType.gltf", "scene must be a whole number"},
        {"no_scene", "TestNoRootNode/NoScene.gltf", "has no scene"},
        {"scene_without_nodes", "TestNoRootNode/SceneWithoutNodes.gltf", "no node with a mesh"},
        {"draco", "draco/2CylinderEngine.gltf", "compressed with KHR_draco_mesh_compression"},
        {"morph", "glTF-Sample-Models/AnimatedMorphCube-glTF/AnimatedMorphCube.gltf", "morph"},
        {"skin", "simple_skin/simple_skin.gltf", "nodes[0] has a skin"},
        {"bad_array", "wrongTypes/badArray.gltf", "primitives must be an array"}};
    const std::array<std::string, 7> modes{"POINTS", "LINES", "LINE_LOOP", "LINE_STRIP",
                                           "",       "",      ""};
    const std::array<std::size_t, 16> mode_of{0, 1, 2, 3, 5, 6, 4, 0, 1, 2, 3, 5, 6, 4, 4, 4};
    for (std::size_t i = 0; i < mode_of.size(); ++i)
    {
        const std::string number = (i < 10 ? "0" : "") + std::to_string(i);
        all.push_back(
            {"mode_" + number,
             "glTF-Asset-Generator/Mesh_PrimitiveMode/Mesh_PrimitiveMode_" + number + ".gltf",
             modes.at(mode_of[i])});
    }
    return all;
}

std::string name_of_sample(const testing::TestParamInfo<Sample>& value)
{
    return value.param.name;
}

INSTANTIATE_TEST_SUITE_P(Samples, SecondOpinion, testing::ValuesIn(samples()), name_of_sample);

} // namespace
} // namespace tactus::test
