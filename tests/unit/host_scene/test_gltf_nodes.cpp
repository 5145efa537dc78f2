// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/random.hpp"
#include "tests/unit/host_scene/scene_files.hpp"

#include <Eigen/Geometry>

/// Nodes that are objects, with their names and poses.

namespace tactus::test
{
namespace
{

using Eigen::Vector3d;
using nlohmann::json;

/// Place of a point of an object's mesh in the world.
Vector3d placed(const Pose& pose, const Vector3d& point)
{
    const auto& [x, y, z, w] = pose.rotation;
    const Eigen::Quaterniond rotation(w, x, y, z);
    return Vector3d(pose.translation_m.data()) + pose.scale * (rotation * point);
}

std::vector<SceneObject> objects_of(const json& scene)
{
    const SceneFiles files;
    const auto opened = files.open(scene);
    if (!opened)
    {
        ADD_FAILURE() << opened.error().text;
        return std::vector<SceneObject>(1);
    }
    return opened.value().objects();
}

std::vector<std::string> names_of(const json& scene)
{
    std::vector<std::string> names;
    for (const SceneObject& object : objects_of(scene))
    {
        names.push_back(object.name);
    }
    return names;
}

TEST(GltfNodes, multiply_the_transforms_of_their_parents)
{
    // Each node's transform is applied to a point separately, from the leaf to the root.
    Random random(1);
    for (int round = 0; round < 50; ++round)
    {
        json scene = tetrahedron_scene();
        scene["nodes"] = json::array();
        const Vector3d local(0.3, -0.7, 1.1);
        constexpr int kDepth = 6;
        std::vector<std::array<double, 8>> chain;
        for (int i = 0; i < kDepth; ++i)
        {
            std::array<double, 8> n{}; // Translation, quaternion, scale.
            for (std::size_t k = 0; k < 7; ++k)
            {
                n[k] = random.between(-1.0, 1.0);
            }
            const double length = Eigen::Map<const Eigen::Vector4d>(&n[3]).norm();
            for (std::size_t k = 3; k < 7; ++k)
            {
                n[k] /= length;
            }
            n[7] = random.between(0.5, 2.0);
            chain.push_back(n);
            json node;
            if (i > 0 && i % 2 == 0) // The same as a matrix.
            {
                const Eigen::Matrix3d m =
                    n[7] * Eigen::Quaterniond(n[6], n[3], n[4], n[5]).toRotationMatrix();
                json& matrix = node["matrix"];
                for (int c = 0; c < 3; ++c)
                {
                    for (int r = 0; r < 3; ++r)
                    {
                        matrix.push_back(m(r, c));
                    }
                    matrix.push_back(0.0);
                }
                for (std::size_t k = 0; k < 3; ++k)
                {
                    matrix.push_back(n[k]);
                }
                matrix.push_back(1.0);
            }
            else
            {
                node["translation"] = {n[0], n[1], n[2]};
                node["rotation"] = {n[3], n[4], n[5], n[6]};
                node["scale"] = {n[7], n[7], n[7]};
            }
            if (i + 1 < kDepth)
            {
                node["children"] = {i + 1};
            }
            scene["nodes"].push_back(node);
        }
        scene["nodes"].back()["mesh"] = 0;
        Vector3d expected = local;
        for (auto node = chain.rbegin(); node != chain.rend(); ++node)
        {
            const auto& n = *node;
            const Vector3d q(n[3], n[4], n[5]);
            const Vector3d t = 2.0 * q.cross(n[7] * expected);
            expected = n[7] * expected + n[6] * t + q.cross(t) + Vector3d(n[0], n[1], n[2]);
        }
        const auto objects = objects_of(scene);
        EXPECT_NEAR((placed(objects.front().pose, local) - expected).norm(), 0.0, 1e-12)
            << "round " << round;
        EXPECT_FALSE(objects.front().mesh->is_mirrored);
    }
}

TEST(GltfNodes, that_mirror_show_a_mesh_of_their_own_with_its_outside_outside)
{
    json scene = tetrahedron_scene();
    scene["nodes"][0]["scale"] = {2.0, -2.0, 2.0};
    scene["nodes"][0]["rotation"] = {0.0, 0.6, 0.0, 0.8};
    scene["nodes"].push_back({{"name", "plain"}, {"mesh", 0}});
    scene["scenes"][0]["nodes"] = {0, 1};
    const SceneFiles files;
    auto opened = files.open(scene);
    ASSERT_TRUE(opened) << opened.error().text;
    const auto& objects = opened.value().objects();
    ASSERT_TRUE(objects[0].mesh->is_mirrored);
    ASSERT_FALSE(objects[1].mesh->is_mirrored);
    const TriangleMesh mirrored = opened.value().read_mesh(*objects[0].mesh).value().mesh;
    const TriangleMesh plain = opened.value().read_mesh(*objects[1].mesh).value().mesh;
    const Eigen::Quaterniond turn(0.8, 0.0, 0.6, 0.0);
    for (std::size_t v = 0; v < plain.positions.size(); ++v)
    {
        const Vector3d source(plain.positions[v].data());
        const Vector3d expected =
            turn * Vector3d(2.0 * source.x(), -2.0 * source.y(), 2.0 * source.z());
        const Vector3d found = placed(objects[0].pose, Vector3d(mirrored.positions[v].data()));
        EXPECT_NEAR((found - expected).norm(), 0.0, 1e-12);
    }
    const auto volume = [](const TriangleMesh& mesh)
    {
        double six = 0.0;
        for (const auto& [a, b, c] : mesh.faces)
        {
            six += Vector3d(mesh.positions[a].data())
                       .dot(Vector3d(mesh.positions[b].data())
                                .cross(Vector3d(mesh.positions[c].data())));
        }
        return six / 6.0;
    };
    EXPECT_GT(volume(plain), 0.1);
    EXPECT_NEAR(volume(mirrored), volume(plain), 1e-12);
}

TEST(GltfNodes, with_a_shear_or_scale_that_a_parent_undoes_are_taken)
{
    json scene = tetrahedron_scene();
    scene["nodes"] = {{{"children", {1}}, {"scale", {1.0, 2.0, 4.0}}},
                      {{"mesh", 0}, {"scale", {2.0, 1.0, 0.5}}}};
    EXPECT_DOUBLE_EQ(objects_of(scene).front().pose.scale, 2.0);
}

TEST(GltfNodes, a_scale_that_single_precision_rounds_out_of_range_is_taken)
{
    json scene = tetrahedron_scene();
    const double rounded = 0.0009999999310821295;
    scene["nodes"][0]["scale"] = {rounded, rounded, rounded};
    EXPECT_EQ(objects_of(scene).front().pose.scale, 1e-3);
}

TEST(GltfNodes, are_objects_by_a_mesh_or_a_model_and_called_what_they_are_called)
{
    json scene = tetrahedron_scene();
    scene["nodes"] = {{{"name", "empty"}, {"children", {3}}},
                      {{"name", "cup"}, {"mesh", 0}},
                      {{"name", "cup"}, {"mesh", 0}},
                      {{"name", "caf\u00e9 1"}, {"mesh", 0}},
                      {{"mesh", 0}},
                      {{"name", "jar"}, {"extras", {{"tactus", {{"model", "j.spm"}}}}}},
                      {{"name", "of no scene"}, {"mesh", 0}}};
    scene["scenes"][0]["nodes"] = {5, 0, 1, 2, 4};
    EXPECT_EQ(names_of(scene),
              (std::vector<std::string>{"cup", "cup-2", "caf\u00e9_1", "node4", "jar"}));
}

TEST(GltfNodes, belong_to_the_files_scene_or_to_the_first)
{
    json scene = tetrahedron_scene();
    scene["nodes"].push_back({{"name", "other"}, {"mesh", 0}});
    scene["scenes"].push_back({{"nodes", {1}}});
    EXPECT_EQ(names_of(scene), std::vector<std::string>{"thing"});
    scene["scene"] = 1;
    EXPECT_EQ(names_of(scene), std::vector<std::string>{"other"});
    scene.erase("scene");
    EXPECT_EQ(names_of(scene), std::vector<std::string>{"thing"});
}

TEST(GltfNodes, say_in_their_extras_how_they_feel)
{
    json scene = tetrahedron_scene();
    scene["nodes"][0]["extras"] = {{"anything", 1},
                                   {"tactus",
                                    {{"material",
                                      {{"stiffness", 800},
                                       {"static", 0.5},
                                       {"damping", 2},
                                       {"viscosity", 3},
                                       {"texture_height", 1e-4},
                                       {"texture_length", 0.01}}},
                                     {"model", "cup.1.spm"}}}};
    const SceneObject object = objects_of(scene).front();
    EXPECT_EQ(object.model, "cup.1.spm");
    EXPECT_FALSE(object.mesh) << "the mesh is for eyes";
    EXPECT_EQ(object.material.stiffness_n_per_m, 800.0);
    EXPECT_EQ(object.material.static_friction, 0.5);
    EXPECT_EQ(object.material.dynamic_friction, 0.5);
    EXPECT_EQ(object.material.damping_n_s_per_m, 2.0);
    EXPECT_EQ(object.material.viscosity_n_s_per_m, 3.0);
    EXPECT_EQ(object.material.texture_height_m, 1e-4);
    EXPECT_EQ(object.material.texture_length_m, 0.01);
    scene["nodes"][0]["extras"] = "a text";
    EXPECT_EQ(objects_of(scene).front().material.stiffness_n_per_m, Material{}.stiffness_n_per_m);
}

TEST(GltfNodes, that_are_not_touched_need_not_be_fit_for_it)
{
    json scene = tetrahedron_scene();
    const json untouched = {{"tactus", {{"touch", false}}}};
    scene["nodes"].push_back({{"name", "flat"}, {"mesh", 0}, {"scale", {1, 0, 1}}});
    scene["nodes"].push_back({{"name", "skinned"}, {"mesh", 0}, {"skin", 0}});
    scene["nodes"].push_back({{"name", "lines"}, {"mesh", 1}});
    scene["meshes"].push_back({{"primitives", {{{"mode", 1}}}}});
    for (std::size_t node = 1; node <= 3; ++node)
    {
        scene["nodes"][node]["extras"] = untouched;
    }
    scene["scenes"][0]["nodes"] = {0, 1, 2, 3};
    const auto objects = objects_of(scene);
    ASSERT_EQ(objects.size(), 4U);
    EXPECT_TRUE(objects[0].is_touched);
    EXPECT_FALSE(objects[1].is_touched || objects[2].is_touched || objects[3].is_touched);
}

TEST(GltfNodes, in_a_chain_as_long_as_the_bound_are_no_matter)
{
    json scene = tetrahedron_scene();
    scene["nodes"] = json::array();
    constexpr int kNodes = 65'536;
    for (int i = 0; i + 1 < kNodes; ++i)
    {
        scene["nodes"].push_back({{"children", {i + 1}}, {"translation", {0.0, 0.0, 0.125}}});
    }
    scene["nodes"].push_back({{"mesh", 0}});
    EXPECT_EQ(objects_of(scene).front().pose.translation_m[2], 0.125 * (kNodes - 1));
}

} // namespace
} // namespace tactus::test
