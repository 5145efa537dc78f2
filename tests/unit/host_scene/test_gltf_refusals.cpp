// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/host_scene/scene_files.hpp"

#include <cstring>
#include <limits>
#include <numeric>
#include <utility>

/// Refused files, each with one line that names the file and the fault.

namespace tactus::test
{
namespace
{

using nlohmann::json;

/// Change of tetrahedron_scene(), with the refusal after the file's name.
struct Case
{
    std::string expected;
    std::string changes; ///< Values by path, as in JSON; null removes one.
};

std::string list(std::size_t count, const std::string& value)
{
    std::string text = "[" + value;
    for (std::size_t i = 1; i < count; ++i)
    {
        text += "," + value;
    }
    return text + "]";
}

/// Pointer for a path, also relative to the only node or primitive or our extras.
json::json_pointer pointer_to(const std::string& path)
{
    for (const auto& [begin, place] :
         {std::pair("node/", "/nodes/0/"), std::pair("primitive/", "/meshes/0/primitives/0/"),
          std::pair("ours/", "/nodes/0/extras/tactus/")})
    {
        if (path.starts_with(begin))
        {
            return json::json_pointer(place + path.substr(std::strlen(begin)));
        }
    }
    return json::json_pointer(path);
}

json changed_scene(const std::string& changes)
{
    json scene = tetrahedron_scene();
    const json values = json::parse("{" + changes + "}");
    for (const auto& [path, value] : values.items())
    {
        const json::json_pointer pointer = pointer_to(path);
        if (value.is_null())
        {
            scene.at(pointer.parent_pointer()).erase(pointer.back());
        }
        else
        {
            scene[pointer] = value;
        }
    }
    return scene;
}

TEST(GltfRefusals, name_what_is_wrong_with_a_scene)
{
    const std::string mesh = "mesh 'tetra' (meshes[0]): ";
    const std::string thing = "node 'thing' (nodes[0]) ";
    std::vector<int> numbers(4'097);
    std::iota(numbers.begin(), numbers.end(), 0);
    const std::vector<Case> cases{
        {"lacks 'asset'", R"("/asset": null)"},
        {"asset.version is '1.0'; only glTF 2 is read", R"("/asset/version": "1.0")"},
        {"asset.minVersion is '2.1'; only 2.0",
         R"("/asset": {"version": "2.2", "minVersion": "2.1"})"},
        {"extensionsRequired[0] is 'KHR_no?idea', which is not supported: it is unknown",
         R"("/extensionsRequired": ["KHR_no\nidea"])"},
        {"extensionsRequired[0] is 'MPEG_accessor_timed', which is not supported: it adds streamed "
         "meshes",
         R"("/extensionsRequired": ["MPEG_accessor_timed"])"},
        {"must be an object", R"("": [])"},
        {"nodes must be an array", R"("/nodes": {})"},
        {"has no scene", R"("/scenes": null)"},
        {"scene must be a whole number below 1, the count of scenes", R"("/scene": 1)"},
        {"its scene has no node with a mesh or a model", R"("/scenes/0/nodes": [])"},
        {"scenes[0].nodes[0] must be a whole number below 1, the count of nodes",
         R"("/scenes/0/nodes": [1])"},
        {"scenes[0].nodes[0] must be a whole number below 1, the count of nodes",
         R"("/scenes/0/nodes": [-1])"},
        {"scenes[0].nodes[0] is node 'thing' (nodes[0]), which is a child",
         R"("/nodes/1": {"children": [0]})"},
        {thing + "is its own ancestor", R"("node/children": [0])"},
        {"nodes[2] is its own ancestor",
         R"("/nodes/1": {"mesh": 0}, "/nodes/2": {"children": [3]}, "/nodes/3": {"children": [1,
            2]})"},
        {thing + "has two parents, nodes[1] and nodes[2]",
         R"("/nodes/1": {"children": [0]}, "/nodes/2": {"children": [0]})"},
        {"nodes[0].children[0] must be a whole number below 1, the count of nodes",
         R"("node/children": [7])"},
        {"nodes[0].matrix has 15 numbers; 16 are needed", "\"node/matrix\": " + list(15, "1")},
        {"nodes[0].matrix must have the last row 0 0 0 1", "\"node/matrix\": " + list(16, "1")},
        {"nodes[0] has both a matrix and",
         R"("node/matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], "node/scale": [1, 1,
            1])"},
        {"nodes[0].matrix[0] must be a number", "\"node/matrix\": " + list(16, "\"NaN\"")},
        {"nodes[0].rotation has the length 2", R"("node/rotation": [0, 0, 0, 2])"},
        {thing + "has no finite pose",
         R"("/nodes/1": {"children": [0], "scale": [1e200, 1e200, 1e200]},
            "/scenes/0/nodes": [1], "node/scale": [1e200, 1e200, 1e200])"},
        {thing + "has a scale of 0", R"("node/scale": [1, 0, 1])"},
        {thing + "scales its axes by 1, 2 and 1;", R"("node/scale": [1, 2, 1])"},
        {thing + "scales its axes by 1, 1.0001 and 1;", R"("node/scale": [1, 1.0001, 1])"},
        {thing + "has axes that are not perpendicular",
         R"("node/matrix": [1, 0, 0, 0, 0.6, 0.8, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])"},
        {thing + "has a scale of 0.00099; 0.001 to 1000 is allowed",
         R"("node/scale": [0.00099, 0.00099, 0.00099])"},
        {thing + "lies farther than 10000 m", R"("node/translation": [0, 10001, 0])"},
        {thing + "has a skin", R"("node/skin": 0)"},
        {"nodes[0].mesh must be a whole number below 1, the count of meshes", R"("node/mesh": 1)"},
        {"every object is excluded by extras.tactus.touch = false", R"("ours/touch": false)"},
        {"nodes[0].extras.tactus.touch must be true or false", R"("ours/touch": 0)"},
        {"nodes[0].extras.tactus has an unknown key 'Model'; known keys are model material touch",
         R"("ours/Model": "a.spm")"},
        {"nodes[0].extras.tactus.model is '../a.spm'; must be an .spm file in",
         R"("ours/model": "../a.spm")"},
        {"nodes[0].extras.tactus.model is 'a.ply'", R"("ours/model": "a.ply")"},
        {"nodes[0].extras.tactus.model is '.spm'", R"("ours/model": ".spm")"},
        {thing + "mirrors its model", R"("ours/model": "a.spm", "node/scale": [-1, 1, 1])"},
        {"nodes[0].extras.tactus.material has an unknown key 'stifness'",
         R"("ours/material": {"stifness": 1})"},
        {"nodes[0].extras.tactus.material must have a stiffness of 1 to 3000 N/m",
         R"("ours/material": {"stiffness": 3001})"},
        {"nodes[0].extras.tactus.material must have",
         R"("ours/material": {"texture_height": 0.001, "texture_length": 0.001})"},
        {"nodes[0].extras.tactus.material must have",
         R"("ours/material": {"static": 0.1, "dynamic": 0.2})"},
        {mesh + "meshes[0].primitives[0].mode must be a whole number below 7, the count of modes",
         R"("primitive/mode": 7)"},
        {mesh + "meshes[0].primitives[0] has morph targets",
         R"("primitive/targets": [{"POSITION": 0}])"},
        {mesh + "meshes[0].primitives[0] is compressed with KHR_draco_mesh_compression",
         R"("/accessors/0/bufferView": null,
            "primitive/extensions": {"KHR_draco_mesh_compression": {}})"},
        {mesh + "bufferViews[0] is compressed with KHR_meshopt_compression",
         R"("/buffers/0/uri": null,
            "/bufferViews/0/extensions": {"KHR_meshopt_compression": {}})"},
        {mesh + "meshes[0].primitives[0] is compressed with KHR_draco_mesh_compression",
         R"("/extensionsRequired": ["KHR_draco_mesh_compression"],
            "primitive/extensions": {"KHR_draco_mesh_compression": {}})"},
        {mesh + "bufferViews[0] is compressed with EXT_meshopt_compression",
         R"("/extensionsRequired": ["EXT_meshopt_compression"],
            "/bufferViews/0/extensions": {"EXT_meshopt_compression": {}})"},
        {"meshes[0].primitives[0].indices must be a whole number below 2, the count of accessors",
         R"("primitive/indices": 2)"},
        {mesh + "meshes[0].primitives[0] has 11 corners; triangles have a multiple of 3",
         R"("/accessors/1/count": 11)"},
        {mesh + "accessors[1] has element 5: 3; there are 3 positions",
         R"("/accessors/0/count": 3)"},
        {mesh + "accessors[1] can't be indices",
         R"("/accessors/1/componentType": 5126, "/accessors/1/count": 6)"},
        {mesh + "accessors[1] can't be indices", R"("/accessors/1/componentType": 5122)"},
        {mesh + "accessors[0] has integer positions without requiring",
         R"("/accessors/0/componentType": 5122)"},
        {mesh + "accessors[0].componentType is 5124", R"("/accessors/0/componentType": 5124)"},
        {mesh + "accessors[0].type must be SCALAR for indices and VEC3",
         R"("/accessors/0/type": "VEC2")"},
        {mesh + "accessors[0].count must be at least 1", R"("/accessors/0/count": 0)"},
        {mesh + "accessors[0] has 5 elements, 12 bytes apart, in 48 bytes",
         R"("/accessors/0/count": 5)"},
        {mesh + "accessors[0].count must be a whole number of 0 to 4294967294",
         R"("/accessors/0/count": 1e15)"},
        {mesh + "meshes[0].primitives[0] exceeds the limit of ",
         R"("/accessors/0/bufferView": null, "/accessors/0/count": 4000000000)"},
        {mesh + "accessors[0] begins at byte 49, but its bufferView has 48 bytes",
         R"("/accessors/0/byteOffset": 49)"},
        {mesh + "accessors[0] has 4 elements, 12 bytes apart, in 47 bytes",
         R"("/accessors/0/byteOffset": 1)"},
        {mesh + "accessors[0] has elements of 12 bytes, 8 bytes apart",
         R"("/bufferViews/0/byteStride": 8)"},
        {mesh + "bufferViews[1] ends at byte 73, but its buffer has 72 bytes",
         R"("/bufferViews/1/byteLength": 25)"},
        {mesh + "bufferViews[1] ends at byte", R"("/bufferViews/1/byteOffset": 4294967295)"},
        {mesh + "accessors[0].bufferView must be a whole number below 2, the count of bufferViews",
         R"("/accessors/0/bufferView": 2)"},
        {mesh + "buffers[0] has 72 bytes; its byteLength is 73", R"("/buffers/0/byteLength": 73)"},
        {mesh + "buffers[0].uri 'b.bin': no such file; 72 bytes are needed",
         R"("/buffers/0/uri": "b.bin")"},
        {mesh + "buffers[0].uri '.': is a directory, not a file", R"("/buffers/0/uri": ".")"},
        {mesh + "buffers[0].uri is '../a.bin'; it must name a file in",
         R"("/buffers/0/uri": "../a.bin")"},
        {mesh + "buffers[0].uri is '/etc/hosts'; it must name",
         R"("/buffers/0/uri": "/etc/hosts")"},
        {mesh + "buffers[0].uri is 'http://a/b'; it must name",
         R"("/buffers/0/uri": "http://a/b")"},
        {mesh + "buffers[0] has no 'uri', and the file has no binary chunk",
         R"("/buffers/0/uri": null)"},
        {mesh + "buffers[0].uri has a data URI that is not base64",
         R"("/buffers/0/uri": "data:;base64,AA*A")"},
        {mesh + "buffers[0].uri has a data URI without ';base64,'",
         R"("/buffers/0/uri": "data:text/plain,hello")"},
        {mesh + "accessors[0].sparse.indices [1] is 0; indices must increase",
         R"("/accessors/0/sparse": {"count": 2, "indices": {"bufferView": 0,
            "componentType": 5121}, "values": {"bufferView": 0}})"},
        {mesh + "accessors[0].sparse has 4 elements in too few bytes",
         R"("/accessors/0/sparse": {"count": 4, "indices": {"bufferView": 1,
            "componentType": 5123}, "values": {"bufferView": 1}})"},
        {"has 65537 nodes; at most 65536", "\"/nodes\": " + list(65'537, "{}")},
        {"has more than 4096 objects", "\"/nodes\": " + list(4'097, R"({"mesh": 0})") +
                                           R"(, "/scenes/0/nodes": )" + json(numbers).dump()},
        {"has more than 4000000 keys and values of JSON", "\"/extras\": " + list(4'000'000, "0")},
    };
    const SceneFiles files;
    for (const Case& spoilt : cases)
    {
        const std::string refusal = files.refusal(changed_scene(spoilt.changes).dump());
        EXPECT_NE(refusal.find(spoilt.expected), std::string::npos)
            << refusal << "\nwithout: " << spoilt.expected;
    }
}

TEST(GltfRefusals, of_nodes_and_meshes_name_the_ways_out)
{
    const SceneFiles files;
    for (const std::string changes :
         {R"("node/scale": [1, 0, 1])", R"("node/scale": [1, 2, 1])",
          R"("node/matrix": [1, 0, 0, 0, 0.6, 0.8, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])",
          R"("node/scale": [0.0001, 0.0001, 0.0001])", R"("node/translation": [0, 10001, 0])",
          R"("node/skin": 0)", R"("primitive/targets": [{"POSITION": 0}])"})
    {
        const std::string refusal = files.refusal(changed_scene(changes).dump());
        EXPECT_NE(refusal.find("in the modeller"), std::string::npos) << refusal;
        EXPECT_NE(refusal.find("extras.tactus.touch = false"), std::string::npos) << refusal;
    }
}

TEST(GltfRefusals, text_that_is_no_json_is_refused_with_its_place)
{
    const SceneFiles files;
    EXPECT_EQ(files.refusal("hello"), "is not JSON at byte 1, after 'h'");
    EXPECT_EQ(files.refusal("{\"asset\": "), "the JSON ends too early, at byte 10");
    EXPECT_NE(files.refusal(R"({"a": 1e999})").find("is not JSON"), std::string::npos);
    EXPECT_NE(files.refusal(R"({"a": NaN})").find("is not JSON"), std::string::npos);
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
    EXPECT_NE(SceneFiles()
                  .refusal(scene.dump())
                  .find("exceeds the limit of 1004608 elements that meshes may read"),
              std::string::npos);
}

TEST(GltfRefusals, a_glb_cut_anywhere_is_refused)
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
