// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/host_scene/scene_files.hpp"

/// Meshes of glTF files: location and coding of their bytes.

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

} // namespace
} // namespace tactus::test
