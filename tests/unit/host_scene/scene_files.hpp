// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/scene/scene.hpp"
#include "tests/shared/temporary_folder.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstring>
#include <initializer_list>
#include <string>

namespace tactus::test
{

/// Bytes of consecutive values.
template <typename T>
std::string raw(std::initializer_list<T> values)
{
    std::string bytes(values.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), std::data(values), bytes.size());
    return bytes;
}

/// Tetrahedron, faces outward: 48 bytes of positions, then 24 of indices.
inline std::string tetrahedron_bytes()
{
    return raw<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0.125F, 0.25F, 1}) +
           raw<std::uint16_t>({0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3});
}

/// One node that shows it, with its buffer in a.bin.
inline nlohmann::json tetrahedron_scene()
{
    return nlohmann::json::parse(R"({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "thing", "mesh": 0}],
        "meshes": [{"name": "tetra",
                    "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
        "bufferViews": [{"buffer": 0, "byteLength": 48},
                        {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
        "buffers": [{"uri": "a.bin", "byteLength": 72}]})");
}

/// GLB of two chunks, padded as the standard requires.
inline std::string glb(std::string json, std::string binary)
{
    json.append((4 - json.size() % 4) % 4, ' ');
    binary.append((4 - binary.size() % 4) % 4, '\0');
    const auto u32 = [](std::size_t value) { return raw({static_cast<std::uint32_t>(value)}); };
    const std::string chunks =
        u32(json.size()) + "JSON" + json + u32(binary.size()) + std::string("BIN\0", 4) + binary;
    return "glTF" + u32(2) + u32(12 + chunks.size()) + chunks;
}

/// Scene file with a.bin, in a separate folder.
struct SceneFiles
{
    explicit SceneFiles(std::string binary = tetrahedron_bytes())
    {
        folder_.write("a.bin", binary);
    }

    Result<Scene, Refusal> open(const nlohmann::json& json) const { return open(json.dump()); }
    Result<Scene, Refusal> open(const std::string& text) const
    {
        return Scene::open(folder_.write("scene.gltf", text));
    }
    [[nodiscard]] const TemporaryFolder& folder() const noexcept { return folder_; }

    /// Refusal of the scene or one of its meshes after the file's name; empty if there is none.
    [[nodiscard]] std::string refusal(const std::string& text) const
    {
        auto scene = open(text);
        if (!scene)
        {
            return without_name(scene.error().text);
        }
        for (const SceneObject& object : scene.value().objects())
        {
            if (object.is_touched && object.mesh)
            {
                if (const auto mesh = scene.value().read_mesh(*object.mesh); !mesh)
                {
                    return without_name(mesh.error().text);
                }
            }
        }
        return "";
    }

private:
    [[nodiscard]] std::string without_name(const std::string& text) const
    {
        const std::string name = (folder_.path() / "scene.gltf").string() + ": ";
        EXPECT_TRUE(text.starts_with(name)) << text;
        EXPECT_EQ(text.find('\n'), std::string::npos) << text;
        return text.substr(std::min(name.size(), text.size()));
    }

    TemporaryFolder folder_{"scene"};
};

inline TriangleMesh first_mesh(Result<Scene, Refusal> scene)
{
    if (!scene)
    {
        ADD_FAILURE() << scene.error().text;
        return {};
    }
    auto mesh = scene.value().read_mesh(scene.value().objects().front().mesh.value());
    if (!mesh)
    {
        ADD_FAILURE() << mesh.error().text;
        return {};
    }
    return std::move(mesh.value().mesh);
}

} // namespace tactus::test
