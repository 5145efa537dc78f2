// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/host_scene/scene_files.hpp"

#include <functional>
#include <limits>
#include <ostream>

/// Files that are refused, each with one line that names the file and what in it is wrong.

namespace tactus::test
{

namespace
{

using nlohmann::json;

struct Case
{
    std::string name;
    std::string expected; ///< Behind the file's name.
    std::function<void(json&)> spoil;

    friend std::ostream& operator<<(std::ostream& out, const Case& spoilt)
    {
        return out << spoilt.name;
    }
};

json& node(json& scene)
{
    return scene["nodes"][0];
}
json& primitive(json& scene)
{
    return scene["meshes"][0]["primitives"][0];
}
json& ours(json& scene)
{
    return node(scene)["extras"]["tactus"];
}

const std::vector<Case>& spoilt_scenes()
{
    static const std::string mesh = "mesh 'tetra' (meshes[0]): ";
    static const std::string thing = "node 'thing' (nodes[0]) ";
    static const std::vector<Case> cases{
        {"no_asset", "lacks 'asset'", [](json& s) { s.erase("asset"); }},
        {"version_1", "asset.version is '1.0'; only glTF 2 is read",
         [](json& s) { s["asset"]["version"] = "1.0"; }},
        {"version_3", "asset.minVersion is '2.1'; only 2.0",
         [](json& s) {
             s["asset"] = {{"version", "2.2"}, {"minVersion", "2.1"}};
         }},
        {"extension", "extensionsRequired[0] is 'KHR_no?idea', which is not supported",
         [](json& s) { s["extensionsRequired"] = {"KHR_no\nidea"}; }},
        {"array_root", "must be an object", [](json& s) { s = json::array(); }},
        {"nodes_object", "nodes must be an array", [](json& s) { s["nodes"] = json::object(); }},
        {"no_scene", "has no scene", [](json& s) { s.erase("scenes"); }},
        {"wrong_scene", "scene names none of the 1 scenes", [](json& s) { s["scene"] = 1; }},
        {"empty_scene", "its scene has no node with a mesh or a model",
         [](json& s) { s["scenes"][0]["nodes"] = json::array(); }},
        {"root_beyond", "scenes[0].nodes[0] names none of the 1 nodes",
         [](json& s) { s["scenes"][0]["nodes"] = {1}; }},
        {"root_negative", "scenes[0].nodes[0] names none of the 1 nodes",
         [](json& s) { s["scenes"][0]["nodes"] = {-1}; }},
        {"root_is_child", "scenes[0].nodes[0] is node 'thing' (nodes[0]), which is a child",
         [](json& s) {
             s["nodes"].push_back({{"children", {0}}});
         }},
        {"own_child", thing + "is its own ancestor", [](json& s) { node(s)["children"] = {0}; }},
        {"circle_below", "nodes[2] is its own ancestor",
         [](json& s)
         {
             s["nodes"].push_back({{"mesh", 0}}); // Below the circle of 2 and 3.
             s["nodes"].push_back({{"children", {3}}});
             s["nodes"].push_back({{"children", {1, 2}}});
         }},
        {"two_parents", thing + "has two parents, nodes[1] and nodes[2]",
         [](json& s)
         {
             s["nodes"].push_back({{"children", {0}}});
             s["nodes"].push_back({{"children", {0}}});
         }},
        {"child_beyond", "nodes[0].children[0] names none of the 1 nodes",
         [](json& s) { node(s)["children"] = {7}; }},
        {"many_nodes", "has 65537 nodes; at most 65536",
         [](json& s) { s["nodes"] = json(std::vector<json>(65'537, json::object())); }},
        {"many_objects", "has more than 4096 objects",
         [](json& s)
         {
             for (int i = 1; i <= 4096; ++i)
             {
                 s["nodes"].push_back({{"mesh", 0}});
                 s["scenes"][0]["nodes"].push_back(i);
             }
         }},
        {"many_values", "has more than 4000000 keys and values of JSON",
         [](json& s) { s["extras"] = std::vector<int>(4'000'000, 0); }},
        {"matrix_size", "nodes[0].matrix has 15 numbers and needs 16",
         [](json& s) { node(s)["matrix"] = std::vector<int>(15, 1); }},
        {"matrix_row", "nodes[0].matrix must have the last row 0 0 0 1",
         [](json& s) { node(s)["matrix"] = std::vector<int>(16, 1); }},
        {"matrix_and_scale", "nodes[0] has both a matrix and",
         [](json& s)
         {
             node(s)["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
             node(s)["scale"] = {1, 1, 1};
         }},
        {"matrix_text", "nodes[0].matrix[0] must be a number",
         [](json& s) { node(s)["matrix"] = std::vector<std::string>(16, "NaN"); }},
        {"long_quaternion", "nodes[0].rotation has the length 2",
         [](json& s) {
             node(s)["rotation"] = {0, 0, 0, 2};
         }},
        {"overflow", thing + "stands nowhere",
         [](json& s)
         {
             s["nodes"].push_back({{"children", {0}}, {"scale", {1e200, 1e200, 1e200}}});
             s["scenes"][0]["nodes"] = {1};
             node(s)["scale"] = {1e200, 1e200, 1e200};
         }},
        {"flat", thing + "has a scale of 0",
         [](json& s) {
             node(s)["scale"] = {1, 0, 1};
         }},
        {"uneven", thing + "scales its axes by 1, 2 and 1;",
         [](json& s) {
             node(s)["scale"] = {1, 2, 1};
         }},
        {"hardly_uneven", thing + "scales its axes by 1, 1.0001 and 1;",
         [](json& s) {
             node(s)["scale"] = {1, 1.0001, 1};
         }},
        {"sheared", thing + "has axes that are not perpendicular",
         [](json& s) { node(s)["matrix"] = {1, 0, 0, 0, 0.6, 0.8, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; }},
        {"small", thing + "has a scale of 0.00099; 0.001 to 1000 is allowed",
         [](json& s) {
             node(s)["scale"] = {0.00099, 0.00099, 0.00099};
         }},
        {"far", thing + "stands farther than 10000 m",
         [](json& s) {
             node(s)["translation"] = {0, 10001, 0};
         }},
        {"skin", thing + "has a skin", [](json& s) { node(s)["skin"] = 0; }},
        {"mesh_beyond", "nodes[0].mesh names none of the 1 meshes",
         [](json& s) { node(s)["mesh"] = 1; }},
        {"untouched", "every object says that it isn't touched",
         [](json& s) { ours(s)["touch"] = false; }},
        {"touch_number", "nodes[0].extras.tactus.touch must be true or false",
         [](json& s) { ours(s)["touch"] = 0; }},
        {"extras_key", "nodes[0].extras.tactus knows no 'Model'; known are model material touch",
         [](json& s) { ours(s)["Model"] = "a.spm"; }},
        {"model_elsewhere", "nodes[0].extras.tactus.model is '../a.spm'; must be an .spm in",
         [](json& s) { ours(s)["model"] = "../a.spm"; }},
        {"model_kind", "nodes[0].extras.tactus.model is 'a.ply'",
         [](json& s) { ours(s)["model"] = "a.ply"; }},
        {"model_bare", "nodes[0].extras.tactus.model is '.spm'",
         [](json& s) { ours(s)["model"] = ".spm"; }},
        {"mirrored_model", thing + "mirrors its model",
         [](json& s)
         {
             ours(s)["model"] = "a.spm";
             node(s)["scale"] = {-1, 1, 1};
         }},
        {"material_key", "nodes[0].extras.tactus.material knows no 'stifness'",
         [](json& s) {
             ours(s)["material"] = {{"stifness", 1}};
         }},
        {"material_range", "nodes[0].extras.tactus.material must have 1 to 3000 N/m",
         [](json& s) {
             ours(s)["material"] = {{"stiffness", 3001}};
         }},
        {"material_texture", "nodes[0].extras.tactus.material must have",
         [](json& s) {
             ours(s)["material"] = {{"texture_height", 0.001}, {"texture_length", 0.001}};
         }},
        {"material_friction", "nodes[0].extras.tactus.material must have",
         [](json& s) {
             ours(s)["material"] = {{"static", 0.1}, {"dynamic", 0.2}};
         }},
        {"no_primitives", mesh + "meshes[0].primitives are none",
         [](json& s) { s["meshes"][0]["primitives"] = json::array(); }},
        {"lines", mesh + "meshes[0].primitives[0] is made of LINE_STRIP",
         [](json& s) { primitive(s)["mode"] = 3; }},
        {"mode", mesh + "meshes[0].primitives[0].mode names none of the 7 modes",
         [](json& s) { primitive(s)["mode"] = 7; }},
        {"morph", mesh + "meshes[0].primitives[0] has morph targets",
         [](json& s) {
             primitive(s)["targets"] = {{{"POSITION", 0}}};
         }},
        {"draco", mesh + "meshes[0].primitives[0] is compressed with KHR_draco_mesh_compression",
         [](json& s)
         {
             s["extensionsRequired"] = {"KHR_draco_mesh_compression"};
             primitive(s)["extensions"] = {{"KHR_draco_mesh_compression", json::object()}};
         }},
        {"meshopt", mesh + "bufferViews[0] is compressed with EXT_meshopt_compression",
         [](json& s)
         {
             s["extensionsRequired"] = {"EXT_meshopt_compression"};
             s["bufferViews"][0]["extensions"] = {{"EXT_meshopt_compression", json::object()}};
         }},
        {"no_position", mesh + "meshes[0].primitives[0].attributes lacks 'POSITION'",
         [](json& s) { primitive(s)["attributes"].erase("POSITION"); }},
        {"accessor_beyond", "meshes[0].primitives[0].indices names none of the 2 accessors",
         [](json& s) { primitive(s)["indices"] = 2; }},
        {"corners", mesh + "meshes[0].primitives[0] has 11 corners; triangles have a multiple of 3",
         [](json& s) { s["accessors"][1]["count"] = 11; }},
        {"two_corners", mesh + "meshes[0].primitives[0] has 2 corners; a triangle has 3",
         [](json& s)
         {
             primitive(s)["mode"] = 5;
             s["accessors"][1]["count"] = 2;
         }},
        {"index_beyond", mesh + "accessors[1] has element 5: 3; there are 3 positions",
         [](json& s) { s["accessors"][0]["count"] = 3; }},
        {"float_indices", mesh + "accessors[1] can't be indices",
         [](json& s)
         {
             s["accessors"][1]["componentType"] = 5126;
             s["accessors"][1]["count"] = 6;
         }},
        {"signed_indices", mesh + "accessors[1] can't be indices",
         [](json& s) { s["accessors"][1]["componentType"] = 5122; }},
        {"integer_positions", mesh + "accessors[0] has integer positions without requiring",
         [](json& s) { s["accessors"][0]["componentType"] = 5122; }},
        {"component", mesh + "accessors[0].componentType is 5124",
         [](json& s) { s["accessors"][0]["componentType"] = 5124; }},
        {"type", mesh + "accessors[0].type must be SCALAR for indices and VEC3",
         [](json& s) { s["accessors"][0]["type"] = "VEC2"; }},
        {"no_elements", mesh + "accessors[0].count must be at least 1",
         [](json& s) { s["accessors"][0]["count"] = 0; }},
        {"too_many_elements", mesh + "accessors[0] has 5 elements, 12 bytes apart, in 48 bytes",
         [](json& s) { s["accessors"][0]["count"] = 5; }},
        {"huge_count", mesh + "accessors[0].count must be a whole number of 0 to 4294967294",
         [](json& s) { s["accessors"][0]["count"] = 1e15; }},
        {"huge_nothing", mesh + "meshes[0].primitives[0] brings what meshes read above",
         [](json& s)
         {
             s["accessors"][0].erase("bufferView");
             s["accessors"][0]["count"] = 4'000'000'000;
         }},
        {"offset_beyond", mesh + "accessors[0] begins at byte 49 of a bufferView of 48",
         [](json& s) { s["accessors"][0]["byteOffset"] = 49; }},
        {"offset_short", mesh + "accessors[0] has 4 elements, 12 bytes apart, in 47 bytes",
         [](json& s) { s["accessors"][0]["byteOffset"] = 1; }},
        {"stride", mesh + "accessors[0] has elements of 12 bytes, 8 bytes apart",
         [](json& s) { s["bufferViews"][0]["byteStride"] = 8; }},
        {"view_beyond", mesh + "bufferViews[1] reaches byte 73 of a buffer of 72",
         [](json& s) { s["bufferViews"][1]["byteLength"] = 25; }},
        {"view_far", mesh + "bufferViews[1] reaches byte",
         [](json& s) { s["bufferViews"][1]["byteOffset"] = 0xFFFF'FFFF; }},
        {"no_view", mesh + "accessors[0].bufferView names none of the 2 bufferViews",
         [](json& s) { s["accessors"][0]["bufferView"] = 2; }},
        {"short_buffer", mesh + "buffers[0] has 72 bytes; its byteLength says 73",
         [](json& s) { s["buffers"][0]["byteLength"] = 73; }},
        {"missing_buffer", mesh + "buffers[0].uri 'b.bin': no such file; 72 bytes are needed",
         [](json& s) { s["buffers"][0]["uri"] = "b.bin"; }},
        {"buffer_is_folder", mesh + "buffers[0].uri '.': is a directory, not a file",
         [](json& s) { s["buffers"][0]["uri"] = "."; }},
        {"buffer_elsewhere", mesh + "buffers[0].uri is '../a.bin'; it must name a file in",
         [](json& s) { s["buffers"][0]["uri"] = "../a.bin"; }},
        {"buffer_absolute", mesh + "buffers[0].uri is '/etc/hosts'; it must name",
         [](json& s) { s["buffers"][0]["uri"] = "/etc/hosts"; }},
        {"buffer_of_the_web", mesh + "buffers[0].uri is 'http://a/b'; it must name",
         [](json& s) { s["buffers"][0]["uri"] = "http://a/b"; }},
        {"bad_escape", mesh + "buffers[0].uri has a URI with a '%'",
         [](json& s) { s["buffers"][0]["uri"] = "a%2"; }},
        {"no_uri", mesh + "buffers[0] has no 'uri', and the file no binary chunk",
         [](json& s) { s["buffers"][0].erase("uri"); }},
        {"not_base64", mesh + "buffers[0].uri has a data URI that is not base64",
         [](json& s) { s["buffers"][0]["uri"] = "data:;base64,AA*A"; }},
        {"data_as_text", mesh + "buffers[0].uri has a data URI without ';base64,'",
         [](json& s) { s["buffers"][0]["uri"] = "data:text/plain,hello"; }},
        {"sparse_order", mesh + "accessors[0].sparse.indices [1] is 0; they must rise",
         [](json& s)
         {
             s["accessors"][0]["sparse"] = {
                 {"count", 2},
                 {"indices", {{"bufferView", 0}, {"componentType", 5121}}},
                 {"values", {{"bufferView", 0}}}};
         }},
        {"sparse_short", mesh + "accessors[0].sparse has 4 elements in too few bytes",
         [](json& s)
         {
             s["accessors"][0]["sparse"] = {
                 {"count", 4},
                 {"indices", {{"bufferView", 1}, {"componentType", 5123}}},
                 {"values", {{"bufferView", 1}}}};
         }},
    };
    return cases;
}

class SpoiltScenes : public testing::TestWithParam<Case>
{
};

TEST_P(SpoiltScenes, are_refused_by_the_name_of_what_is_wrong)
{
    json scene = tetrahedron_scene();
    GetParam().spoil(scene);
    const std::string refusal = SceneFiles().refusal(scene.dump());
    EXPECT_NE(refusal.find(GetParam().expected), std::string::npos) << refusal;
}

std::string name_of_case(const testing::TestParamInfo<Case>& spoilt)
{
    return spoilt.param.name;
}

INSTANTIATE_TEST_SUITE_P(Gltf, SpoiltScenes, testing::ValuesIn(spoilt_scenes()), name_of_case);

TEST(GltfRefusals, text_that_is_no_json_is_refused_with_its_place)
{
    const SceneFiles files;
    EXPECT_EQ(files.refusal("hello"), "is no JSON at byte 1, behind 'h'");
    EXPECT_EQ(files.refusal("{\"asset\": "), "the JSON ends too early, at byte 10");
    EXPECT_NE(files.refusal(R"({"a": 1e999})").find("is no JSON"), std::string::npos);
    EXPECT_NE(files.refusal(R"({"a": NaN})").find("is no JSON"), std::string::npos);
    EXPECT_NE(files.refusal(std::string(1'000'000, '[')).find("nested deeper than 64"),
              std::string::npos);
    const SceneFiles others(
        raw<float>({0, 0, 0, 1, 0, 0, 0, std::numeric_limits<float>::quiet_NaN(), 0, 0, 0, 1}) +
        tetrahedron_bytes().substr(48));
    EXPECT_EQ(others.refusal(tetrahedron_scene().dump()),
              "mesh 'tetra' (meshes[0]): accessors[0] has element 2: y is nan; must be finite");
}

TEST(GltfRefusals, a_small_file_never_becomes_many_triangles)
{
    json scene = tetrahedron_scene();
    scene["meshes"][0]["primitives"] =
        std::vector<json>(100'000, scene["meshes"][0]["primitives"][0]);
    EXPECT_NE(SceneFiles().refusal(scene.dump()).find("brings what meshes read above 1004608"),
              std::string::npos);
}

TEST(GltfRefusals, a_glb_cut_anywhere_or_with_a_byte_more_is_refused)
{
    json scene = tetrahedron_scene();
    scene["buffers"][0].erase("uri");
    const std::string whole = glb(scene.dump(), tetrahedron_bytes());
    const SceneFiles files;
    ASSERT_EQ(files.refusal(whole), "");
    for (std::size_t length = 0; length < whole.size(); ++length)
    {
        ASSERT_NE(files.refusal(whole.substr(0, length)), "") << length;
    }
    EXPECT_NE(files.refusal(whole + " "), "");
    for (const std::size_t at : {4U, 8U, 12U, 16U}) // Version, length, chunk's length and type.
    {
        std::string spoilt = whole;
        spoilt[at] = static_cast<char>(spoilt[at] + 1);
        EXPECT_NE(files.refusal(spoilt), "") << at;
    }
}

TEST(GltfRefusals, a_gltf_cut_anywhere_is_refused)
{
    const std::string whole = tetrahedron_scene().dump();
    const SceneFiles files;
    for (std::size_t length = 0; length < whole.size(); ++length)
    {
        ASSERT_NE(files.refusal(whole.substr(0, length)), "") << length;
    }
}

} // namespace

} // namespace tactus::test
