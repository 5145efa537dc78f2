// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/host_scene/scene_files.hpp"

#include <fstream>

/// Useless parts are skipped by name, and the rest of the scene is read.

namespace tactus::test
{
namespace
{

using nlohmann::json;

/// Tetrahedron scene whose mesh has an additional primitive.
json with_primitive(const json& primitive)
{
    json scene = tetrahedron_scene();
    scene["meshes"][0]["primitives"].push_back(primitive);
    return scene;
}

SceneMesh read_mesh_of(const json& scene)
{
    const SceneFiles files;
    auto opened = files.open(scene);
    if (!opened)
    {
        ADD_FAILURE() << opened.error().text;
        return {};
    }
    auto mesh = opened.value().read_mesh(opened.value().objects().front().mesh.value());
    if (!mesh)
    {
        ADD_FAILURE() << mesh.error().text;
        return {};
    }
    return mesh.value();
}

struct FoundObjects
{
    std::vector<std::string> names;
    std::vector<std::string> notes;
};

FoundObjects found_in(const json& scene)
{
    const SceneFiles files;
    const auto opened = files.open(scene);
    if (!opened)
    {
        ADD_FAILURE() << opened.error().text;
        return {};
    }
    FoundObjects objects{{}, opened.value().notes()};
    for (const SceneObject& object : opened.value().objects())
    {
        objects.names.push_back(object.name);
    }
    return objects;
}

/// Scene with the node "thing" and a second one.
json with_node(json node)
{
    json scene = tetrahedron_scene();
    node["mesh"] = 0;
    scene["nodes"].push_back(node);
    scene["scenes"][0]["nodes"] = {0, 1};
    return scene;
}

using Names = std::vector<std::string>;

TEST(GltfLeftOut, are_primitives_without_a_surface_beside_one_that_has_it)
{
    const std::vector<std::pair<std::string, json>> cases{
        {"1 primitive of LINES", {{"attributes", {{"POSITION", 0}}}, {"mode", 1}}},
        {"1 primitive of LINE_STRIP", {{"attributes", {{"POSITION", 0}}}, {"mode", 3}}},
        {"1 primitive of POINTS", {{"attributes", {{"POSITION", 0}}}, {"mode", 0}}},
        {"1 primitive of POINTS", {{"attributes", {{"COLOR_0", 9}}}, {"mode", 0}}},
        {"1 primitive without positions", {{"attributes", {{"NORMAL", 0}}}}},
        {"1 primitive of 0 corners", {{"attributes", {{"POSITION", 2}}}}},
        {"1 primitive of 0 corners", {{"attributes", {{"POSITION", 0}}}, {"indices", 2}}},
        {"1 primitive of 2 corners", {{"attributes", {{"POSITION", 0}}}, {"indices", 3}}},
        {"1 primitive in a mode of an extension",
         {{"attributes", {{"_DENSITY", 0}}},
          {"mode", 2'147'483'647},
          {"extensions", {{"EXT_primitive_voxels", json::object()}}}}}};
    for (const auto& [expected, primitive] : cases)
    {
        json scene = with_primitive(primitive);
        scene["accessors"].push_back(
            {{"bufferView", 0}, {"componentType", 5126}, {"count", 0}, {"type", "VEC3"}});
        scene["accessors"].push_back(
            {{"bufferView", 1}, {"componentType", 5123}, {"count", 2}, {"type", "SCALAR"}});
        const SceneMesh mesh = read_mesh_of(scene);
        EXPECT_EQ(mesh.left_out, expected);
        EXPECT_EQ(mesh.mesh.faces.size(), 4U) << expected;
    }
}

TEST(GltfLeftOut, are_named_together_where_they_are_many)
{
    json scene = with_primitive({{"attributes", {{"POSITION", 0}}}, {"mode", 1}});
    scene["meshes"][0]["primitives"].push_back(scene["meshes"][0]["primitives"][1]);
    scene["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", 0}});
    EXPECT_EQ(read_mesh_of(scene).left_out, "2 primitives of LINES, 1 primitive of POINTS");
}

TEST(GltfLeftOut, is_a_mesh_of_which_nothing_has_a_surface)
{
    json scene = tetrahedron_scene();
    auto& primitive = scene["meshes"][0]["primitives"][0];
    primitive["mode"] = 1;
    EXPECT_EQ(read_mesh_of(scene).left_out, "1 primitive of LINES");
    EXPECT_TRUE(read_mesh_of(scene).mesh.faces.empty());
    scene["meshes"][0]["primitives"] = json::array();
    EXPECT_EQ(read_mesh_of(scene).left_out, "no primitives");
    scene["meshes"][0].erase("primitives");
    EXPECT_EQ(read_mesh_of(scene).left_out, "no primitives");
    // An axis as a triangle of two corners, and a point of three equal ones.
    scene = tetrahedron_scene();
    scene["accessors"][1]["count"] = 3;
    scene["accessors"][1]["sparse"] = {{"count", 3},
                                       {"indices", {{"bufferView", 2}, {"componentType", 5121}}},
                                       {"values", {{"bufferView", 3}}}};
    scene["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 3}});
    scene["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 4}, {"byteLength", 6}});
    for (const char* values : {"AAECAAAAAQABAA==", "AAECAAIAAgACAA=="})
    {
        scene["buffers"][1] = {{"uri", std::string("data:;base64,") + values}, {"byteLength", 10}};
        const SceneMesh mesh = read_mesh_of(scene);
        EXPECT_EQ(mesh.left_out, "1 face without area");
        EXPECT_TRUE(mesh.mesh.faces.empty());
    }
}

TEST(GltfLeftOut, are_nodes_that_are_scaled_to_a_point_or_a_line)
{
    for (const auto& scale : {json{0, 0, 0}, json{0, 1, 0}, json{1e-12, 1, 0}})
    {
        const FoundObjects objects = found_in(with_node({{"name", "gone"}, {"scale", scale}}));
        EXPECT_EQ(objects.names, Names{"thing"});
        EXPECT_EQ(objects.notes,
                  Names{"node 'gone' (nodes[1]) left out: scaled to a point or a line"});
    }
    // Scaled by a parent, with intermediate rotations that leave no zero.
    json scene = with_node({{"name", "gone"}, {"rotation", {0.48, 0.36, 0.0, 0.8}}});
    scene["nodes"].push_back({{"children", {1}}, {"scale", {0, 0, 2}}});
    scene["scenes"][0]["nodes"] = {0, 2};
    EXPECT_EQ(found_in(scene).names, Names{"thing"});
}

TEST(GltfLeftOut, are_hidden_nodes_and_all_below_them_unless_they_are_to_be_touched)
{
    json scene = with_node({{"name", "gone"}});
    scene["nodes"].push_back(
        {{"children", {1}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}});
    scene["scenes"][0]["nodes"] = {0, 2};
    EXPECT_EQ(found_in(scene).names, Names{"thing"});
    EXPECT_EQ(found_in(scene).notes,
              Names{"node 'gone' (nodes[1]) left out: hidden by KHR_node_visibility; "
                    "extras.tactus.touch = true keeps it"});
    scene["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = true; // This has no effect.
    EXPECT_EQ(found_in(scene).names, Names{"thing"});
    scene["nodes"][1]["extras"]["tactus"]["touch"] = true;
    EXPECT_EQ(found_in(scene).names, (Names{"thing", "gone"}));
    scene["nodes"][1].erase("extras");
    scene["nodes"][2]["extensions"]["KHR_node_visibility"] = json::object();
    EXPECT_EQ(found_in(scene).names, (Names{"thing", "gone"}));
    scene["nodes"][2]["extensions"]["KHR_node_visibility"]["visible"] = false;
    scene["scenes"][0]["nodes"] = {2};
    EXPECT_NE(SceneFiles().refusal(scene.dump()).find("no object is left to touch: node 'gone'"),
              std::string::npos);
}

TEST(GltfLeftOut, are_lower_levels_of_detail)
{
    json scene = with_node({{"name", "low"}});
    scene["nodes"][0]["extensions"]["MSFT_lod"]["ids"] = {1};
    EXPECT_EQ(found_in(scene).names, Names{"thing"});
    EXPECT_EQ(found_in(scene).notes.size(), 1U);
    scene["nodes"][0]["extensions"]["MSFT_lod"]["ids"] = {0};
    EXPECT_EQ(found_in(scene).names, (Names{"thing", "low"}));
}

TEST(GltfLeftOut, are_told_in_a_line_a_reason)
{
    json scene = tetrahedron_scene();
    for (int i = 1; i <= 5; ++i)
    {
        scene["nodes"].push_back({{"mesh", 0}, {"scale", {0, 0, 0}}});
        scene["scenes"][0]["nodes"].push_back(i);
    }
    EXPECT_EQ(found_in(scene).notes,
              Names{"nodes[1], nodes[2], nodes[3] and 2 more left out: scaled to a point or a "
                    "line"});
}

TEST(GltfLeftOut, are_mistakes_in_nodes_of_no_object)
{
    json scene = tetrahedron_scene();
    scene["nodes"].push_back({{"name", "lamp"}, {"rotation", {0, 0, 0, 0}}});
    scene["nodes"].push_back({{"name", 7}, {"matrix", {1, 2}}});
    scene["nodes"][0]["name"] = nullptr;
    scene["scenes"][0]["nodes"] = {0, 1, 2};
    EXPECT_EQ(found_in(scene).names, Names{"node0"});
}

TEST(GltfLeftOut, are_bytes_behind_a_glb)
{
    json scene = tetrahedron_scene();
    scene["buffers"][0].erase("uri");
    const std::string whole = glb(scene.dump(), tetrahedron_bytes());
    const SceneFiles files;
    const auto opened = files.open(whole + std::string("\r\n\0", 3));
    ASSERT_TRUE(opened) << opened.error().text;
    EXPECT_EQ(opened.value().notes(), Names{"3 bytes after the end of the GLB left out"});
}

TEST(GltfLeftOut, are_no_files_whose_names_a_program_wrote_as_they_are)
{
    const SceneFiles files("");
    std::filesystem::create_directory(files.folder().path() / "sub");
    const std::vector<std::pair<const char*, const char*>> cases{
        {"part%20a%C3%BC.bin", "part a\u00fc.bin"}, {"part b.bin", "part b.bin"},
        {"part 10%.bin", "part 10%.bin"},           {"part%zz.bin", "part%zz.bin"},
        {"part%20c.bin", "part%20c.bin"},           {"sub\\part.bin", "sub/part.bin"},
        {".\\sub\\part%20d.bin", "sub/part d.bin"}, {"./sub/part.bin", "sub/part.bin"}};
    for (const auto& [uri, file] : cases)
    {
        std::ofstream(files.folder().path() / file, std::ios::binary) << tetrahedron_bytes();
        json scene = tetrahedron_scene();
        scene["buffers"][0]["uri"] = uri;
        EXPECT_EQ(files.refusal(scene.dump()), "") << uri;
    }
    json scene = tetrahedron_scene();
    scene["buffers"][0]["uri"] = "..\\a.bin";
    EXPECT_NE(files.refusal(scene.dump()).find("must name a file in"), std::string::npos);
}

} // namespace
} // namespace tactus::test
