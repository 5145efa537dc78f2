// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/detail/gltf_file.hpp"
#include "tests/unit/host_scene/scene_files.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <map>

/// Meshes of glTF files: location and coding of their bytes.
/// Handling of extensions: the table of the docs, notes, and supported ones.
namespace tactus::test
{
namespace
{

using nlohmann::json;

const TriangleMesh kTetrahedron{{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0.125, 0.25, 1}},
                                {{0, 1, 2}, {0, 2, 3}, {2, 1, 3}, {1, 0, 3}}};

/// Vertices are numbered in the order of the faces.
void expect_tetrahedron(const TriangleMesh& mesh)
{
    EXPECT_EQ(mesh.positions, kTetrahedron.positions);
    EXPECT_EQ(mesh.faces, kTetrahedron.faces);
}

/// Positions of `count` separate corners, as the accessor `positions` codes them in `binary`.
std::vector<std::array<double, 3>> positions_of(const std::string& binary, json positions,
                                                const std::vector<std::string>& required = {})
{
    json scene = tetrahedron_scene();
    scene["meshes"][0]["primitives"][0].erase("indices");
    scene["buffers"][0]["byteLength"] = binary.size();
    scene["bufferViews"][0]["byteLength"] = binary.size();
    positions["type"] = "VEC3";
    scene["accessors"][0] = std::move(positions);
    if (!required.empty())
    {
        scene["extensionsRequired"] = required;
    }
    return first_mesh(SceneFiles(binary).open(scene)).positions;
}

TEST(GltfGeometry, reads_the_same_mesh_from_a_file_a_data_uri_and_a_binary_chunk)
{
    json scene = tetrahedron_scene();
    const SceneFiles files;
    expect_tetrahedron(first_mesh(files.open(scene)));
    scene["buffers"][0]["uri"] = "data:application/octet-stream;base64,"
                                 "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAPgAAgD4AAIA/"
                                 "AAACAAEAAAABAAMAAQACAAMAAgAAAAMA";
    expect_tetrahedron(first_mesh(files.open(scene)));
    scene["buffers"][0].erase("uri");
    expect_tetrahedron(first_mesh(files.open(glb(scene.dump(), tetrahedron_bytes()))));
}

TEST(GltfGeometry, reads_files_below_its_folder_with_blanks_in_their_names)
{
    json scene = tetrahedron_scene();
    const SceneFiles files;
    std::filesystem::create_directory(files.folder().path() / "b c");
    files.folder().write("b c/d%.bin", tetrahedron_bytes());
    scene["buffers"][0]["uri"] = "b%20c/d%25.bin";
    expect_tetrahedron(first_mesh(files.open(scene)));
}

TEST(GltfGeometry, reads_indices_of_every_width)
{
    const std::string positions = tetrahedron_bytes().substr(0, 48);
    const auto read = [&](int component, const std::string& indices)
    {
        json scene = tetrahedron_scene();
        scene["accessors"][1]["componentType"] = component;
        scene["bufferViews"][1]["byteLength"] = indices.size();
        scene["buffers"][0]["byteLength"] = 48 + indices.size();
        return first_mesh(SceneFiles(positions + indices).open(scene));
    };
    expect_tetrahedron(read(5121, raw<std::uint8_t>({0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3})));
    expect_tetrahedron(read(5125, raw<std::uint32_t>({0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3})));
}

TEST(GltfGeometry, obeys_offsets_and_strides)
{
    const std::string binary =
        raw<float>({9, 9, 9, /**/ 1, 2, 3, 9, /**/ 4, 5, 6, 9, /**/ 7, 8, 10});
    json scene = tetrahedron_scene();
    scene["meshes"][0]["primitives"][0].erase("indices");
    scene["buffers"][0]["byteLength"] = binary.size();
    scene["bufferViews"][0] = {
        {"buffer", 0}, {"byteOffset", 4}, {"byteStride", 16}, {"byteLength", binary.size() - 4}};
    scene["accessors"][0]["byteOffset"] = 8;
    scene["accessors"][0]["count"] = 3;
    EXPECT_EQ(first_mesh(SceneFiles(binary).open(scene)).positions,
              (std::vector<std::array<double, 3>>{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}}));
}

TEST(GltfGeometry, reads_quantised_positions_by_the_standards_formulas)
{
    using Positions = std::vector<std::array<double, 3>>;
    const std::vector<std::string> quantised{"KHR_mesh_quantization"};
    const auto accessor = [](int component, bool normalized)
    {
        return json{{"bufferView", 0},
                    {"componentType", component},
                    {"count", 3},
                    {"normalized", normalized}};
    };
    const std::string i8 = raw<std::int8_t>({-128, -127, 127, 0, 1, 2, 3, 4, 5});
    EXPECT_EQ(positions_of(i8, accessor(5120, false), quantised),
              (Positions{{-128, -127, 127}, {0, 1, 2}, {3, 4, 5}}));
    EXPECT_EQ(
        positions_of(i8, accessor(5120, true), quantised),
        (Positions{{-1, -1, 1}, {0, 1 / 127.0, 2 / 127.0}, {3 / 127.0, 4 / 127.0, 5 / 127.0}}));
    EXPECT_EQ(positions_of(raw<std::uint8_t>({255, 51, 0, 1, 1, 2, 3, 4, 5}), accessor(5121, true),
                           quantised)[0],
              (std::array{1.0, 0.2, 0.0}));
    EXPECT_EQ(positions_of(raw<std::int16_t>({-32768, 32767, 0, 1, 1, 2, 3, 4, 5}),
                           accessor(5122, true), quantised)[0],
              (std::array{-1.0, 1.0, 0.0}));
    EXPECT_EQ(positions_of(raw<std::uint16_t>({65535, 13107, 0, 1, 1, 2, 3, 4, 5}),
                           accessor(5123, true), quantised)[0],
              (std::array{1.0, 0.2, 0.0}));
}

TEST(GltfGeometry, replaces_sparse_elements_of_a_buffer_and_of_nothing)
{
    using Positions = std::vector<std::array<double, 3>>;
    const std::string binary = raw<float>({1, 1, 1, 2, 2, 2, 3, 3, 3}) +
                               raw<float>({4, 5, 6, 7, 8, 9}) + raw<std::uint8_t>({0, 2});
    json accessor = {{"bufferView", 0}, {"componentType", 5126}, {"count", 3}};
    accessor["sparse"] = {
        {"count", 2},
        {"indices", {{"bufferView", 0}, {"byteOffset", 60}, {"componentType", 5121}}},
        {"values", {{"bufferView", 0}, {"byteOffset", 36}}}};
    EXPECT_EQ(positions_of(binary, accessor), (Positions{{4, 5, 6}, {2, 2, 2}, {7, 8, 9}}));
    accessor.erase("bufferView");
    EXPECT_EQ(positions_of(binary, accessor), (Positions{{4, 5, 6}, {0, 0, 0}, {7, 8, 9}}));
}

TEST(GltfGeometry, joins_primitives_and_shares_the_vertices_of_one_accessor)
{
    json scene = tetrahedron_scene();
    auto& primitives = scene["meshes"][0]["primitives"];
    primitives.push_back(primitives[0]);
    const TriangleMesh mesh = first_mesh(SceneFiles().open(scene));
    EXPECT_EQ(mesh.positions, kTetrahedron.positions);
    ASSERT_EQ(mesh.faces.size(), 8U);
    EXPECT_EQ(mesh.faces[4], mesh.faces[0]);
}

TEST(GltfGeometry, takes_what_may_be_compressed_but_is_here_uncompressed_too)
{
    json scene = tetrahedron_scene();
    scene["extensionsUsed"] = {"KHR_draco_mesh_compression", "SOMEONES_own"};
    scene["meshes"][0]["primitives"][0]["extensions"] = {
        {"KHR_draco_mesh_compression", {{"bufferView", 0}}}};
    expect_tetrahedron(first_mesh(SceneFiles().open(scene)));
}

using detail::ExtensionUse;
using nlohmann::json;

/// Names in the table of docs/scene-files.md, with the first word of its second column.
std::map<std::string, std::string> documented_extensions()
{
    std::ifstream file(TACTUS_SOURCE_DIR "/docs/scene-files.md");
    std::map<std::string, std::string> found;
    for (std::string line; std::getline(file, line);)
    {
        const std::size_t cell = line.find(" | ");
        const std::string names = line.substr(0, cell);
        if (!line.starts_with("| `") || names.find('_') == std::string::npos ||
            names.find("extras") != std::string::npos)
        {
            continue;
        }
        const std::string word =
            line.substr(cell + 3, line.find_first_of(" :", cell + 3) - cell - 3);
        for (std::size_t at = names.find('`'); at != std::string::npos; at = names.find('`', at))
        {
            const std::size_t end = names.find('`', at + 1);
            std::string name = names.substr(at + 1, end - at - 1);
            name = name.ends_with("...") ? name.substr(0, name.size() - 3) : name;
            EXPECT_TRUE(found.emplace(name, word).second) << name << " is there twice";
            at = end + 1;
        }
    }
    return found;
}

std::vector<std::string> notes_of(const json& scene)
{
    const SceneFiles files;
    const auto opened = files.open(scene);
    EXPECT_TRUE(opened) << opened.error().text;
    return opened ? opened.value().notes() : std::vector<std::string>{};
}

TEST(GltfExtensions, do_what_the_table_of_the_docs_says)
{
    const std::map<ExtensionUse, std::string> words{{ExtensionUse::none, "none"},
                                                    {ExtensionUse::read, "read"},
                                                    {ExtensionUse::named, "named"},
                                                    {ExtensionUse::vital, "vital"}};
    std::map<std::string, std::string> known;
    for (const detail::KnownExtension& extension : detail::known_extensions())
    {
        known.emplace(extension.name, words.at(extension.use));
    }
    EXPECT_EQ(documented_extensions(), known);
}

TEST(GltfExtensions, that_leave_something_out_are_named_once_and_the_others_are_not)
{
    for (const detail::KnownExtension& extension : detail::known_extensions())
    {
        const std::string name =
            std::string(extension.name) + (extension.name.ends_with('_') ? "x" : "");
        json scene = tetrahedron_scene();
        scene["extensionsUsed"] = {name, name};
        const auto notes = notes_of(scene);
        if (extension.use == ExtensionUse::named || extension.use == ExtensionUse::vital)
        {
            ASSERT_EQ(notes.size(), 1U) << name;
            EXPECT_TRUE(notes[0].starts_with(fmt::format("extension '{}' ", name))) << notes[0];
        }
        else
        {
            EXPECT_EQ(notes.size(), 0U) << name;
        }
        scene["extensionsRequired"] = {name};
        EXPECT_EQ(SceneFiles().open(scene).has_value(), extension.use != ExtensionUse::vital)
            << name;
    }
}

TEST(GltfExtensions, that_nothing_knows_are_named_wherever_they_stand)
{
    const std::string what = " is unknown; its additions, motions and hidden nodes are not read";
    json scene = tetrahedron_scene();
    scene["extensionsUsed"] = {"ACME_part"};
    EXPECT_EQ(notes_of(scene), std::vector<std::string>{"extension 'ACME_part'" + what});
    scene.erase("extensionsUsed"); // Many exporters omit it.
    scene["meshes"][0]["primitives"][0]["extensions"]["ACME_part"] = json::object();
    EXPECT_EQ(notes_of(scene),
              std::vector<std::string>{"extension 'ACME_part' (meshes[0])" + what});
    scene["nodes"][0]["extensions"]["ACME_part"] = 3;
    scene["extensions"]["ACME_other"] = nullptr;
    EXPECT_EQ(notes_of(scene),
              (std::vector<std::string>{"extension 'ACME_other' (the file)" + what,
                                        "extension 'ACME_part' (nodes[0] and 1 more)" + what}));
}

/// The tetrahedron's node with three instances, and their accessors.
json instanced_scene()
{
    json scene = tetrahedron_scene();
    scene["nodes"][0]["translation"] = {0, 0, 10};
    scene["nodes"][0]["scale"] = {2, 2, 2};
    scene["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
        {"TRANSLATION", 2}, {"ROTATION", 3}, {"SCALE", 4}, {"_ID", 5}};
    const auto add = [&scene](int component, const char* type, int offset, bool is_normalized)
    {
        scene["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", offset}, {"byteLength", 36}});
        scene["accessors"].push_back({{"bufferView", scene["bufferViews"].size() - 1},
                                      {"componentType", component},
                                      {"normalized", is_normalized},
                                      {"count", 3},
                                      {"type", type}});
    };
    add(5126, "VEC3", 72, false);
    add(5122, "VEC4", 108, true);
    add(5126, "VEC3", 144, false);
    scene["buffers"][0]["byteLength"] = 180;
    return scene;
}

std::string instance_bytes(std::array<float, 3> last_scale)
{
    return tetrahedron_bytes() + raw<float>({0, 0, 0, 1, 0, 0, 0, 3, 0}) +
           raw<std::int16_t>({0, 0, 0, 32'767, 0, 0, 23'170, 23'170, 0, 0, 0, -32'767}) +
           std::string(12, '\0') +
           raw<float>({1, 1, 1, 0.5, 0.5, 0.5, last_scale[0], last_scale[1], last_scale[2]});
}

TEST(GltfExtensions, instances_are_objects_of_their_own_in_the_nodes_frame)
{
    const SceneFiles files(instance_bytes({-1, 1, 1}));
    const auto opened = files.open(instanced_scene());
    ASSERT_TRUE(opened) << opened.error().text;
    const auto& objects = opened.value().objects();
    ASSERT_EQ(objects.size(), 3U);
    EXPECT_EQ(objects[0].name, "thing");
    EXPECT_EQ(objects[2].name, "thing-3");
    EXPECT_EQ(objects[1].place, "node 'thing' (nodes[0]) instance 1");
    using Place = std::array<double, 3>;
    EXPECT_EQ(objects[0].pose.translation_m, (Place{0, 0, 10}));
    EXPECT_EQ(objects[1].pose.translation_m, (Place{2, 0, 10}));
    EXPECT_EQ(objects[2].pose.translation_m, (Place{0, 6, 10}));
    EXPECT_EQ(objects[0].pose.scale, 2.0);
    EXPECT_NEAR(objects[1].pose.scale, 1.0, 1e-12);
    EXPECT_NEAR(objects[1].pose.rotation[2], std::sqrt(0.5), 1e-12);
    EXPECT_FALSE(objects[1].mesh->is_mirrored);
    EXPECT_TRUE(objects[2].mesh->is_mirrored);
}

TEST(GltfExtensions, instances_obey_the_rules_of_nodes)
{
    const SceneFiles uneven(instance_bytes({1, 2, 1}));
    EXPECT_NE(uneven.refusal(instanced_scene().dump())
                  .find("node 'thing' (nodes[0]) instance 2 scales its axes by 2, 4 and 2;"),
              std::string::npos);
    const SceneFiles files(instance_bytes({1, 1, 1}));
    json scene = instanced_scene();
    scene["accessors"][4]["count"] = 2;
    EXPECT_NE(files.refusal(scene.dump()).find("SCALE has 2 instances; another attribute has 3"),
              std::string::npos);
    scene = instanced_scene();
    scene["accessors"][3]["type"] = "VEC3";
    EXPECT_NE(files.refusal(scene.dump()).find("has 3 numbers an element; 4 are needed"),
              std::string::npos);
    scene = instanced_scene();
    scene["accessors"][2].erase("bufferView");
    scene["accessors"][2]["count"] = 4'000'000'000U;
    auto& attributes = scene["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
    attributes = {{"TRANSLATION", 2}};
    EXPECT_NE(files.refusal(scene.dump()).find("have 4000000000 instances; at most 4096"),
              std::string::npos);
    attributes = {{"_ID", 2}};
    EXPECT_EQ(files.open(scene).value().objects().size(), 1U);
}

TEST(GltfExtensions, positions_of_double_precision_keep_it)
{
    json scene = tetrahedron_scene();
    scene["extensionsRequired"] = {"KHR_accessor_float64"};
    scene["accessors"][0]["componentType"] = 5130;
    scene["bufferViews"][0]["byteLength"] = 96;
    scene["bufferViews"][1]["byteOffset"] = 96;
    scene["buffers"][0]["byteLength"] = 120;
    const SceneFiles files(raw<double>({0, 0, 0, 1, 0, 0, 0, 1, 0, 1.0 / 3.0, 0.25, 1}) +
                           tetrahedron_bytes().substr(48));
    const TriangleMesh mesh = first_mesh(files.open(scene));
    ASSERT_EQ(mesh.positions.size(), 4U);
    EXPECT_EQ(mesh.positions.back()[0], 1.0 / 3.0);
}

} // namespace
} // namespace tactus::test
