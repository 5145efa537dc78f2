// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/scene/scene_object.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace tactus
{

/// True if a path ends in .gltf or .glb, in either case of letters.
[[nodiscard]] bool has_scene_extension(const std::filesystem::path& path);

/// A glTF 2.0 scene (docs/scene-files.md): its objects, and the meshes that they show. Every
/// refusal is one line that begins with the file's name.
class Scene
{
public:
    /// Reads .gltf and .glb with 1 to kMaxObjects objects, at least one of them touched. Costs the
    /// file's bytes and about 100 bytes for each value of its JSON, which are bounded too; of the
    /// buffers only those with the poses of instances are read.
    [[nodiscard]] static Result<Scene, Refusal> open(const std::filesystem::path& path);

    ~Scene();
    Scene(Scene&&) noexcept;
    Scene& operator=(Scene&&) noexcept;

    /// Objects in the order of the file's nodes.
    [[nodiscard]] const std::vector<SceneObject>& objects() const noexcept { return objects_; }

    /// Notes on ignored or unreadable content, one line each: hidden nodes, and content that
    /// extensions add, move or hide.
    [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

    /// Name of the mesh in the file, as a valid name; not unique. "mesh7" if it has none.
    [[nodiscard]] std::string mesh_name(const MeshUse& use) const;

    /// Description of the mesh for messages: mesh 'arm' (meshes[7]).
    [[nodiscard]] std::string mesh_place(const MeshUse& use) const;

    /// Mesh of an object, in the object's frame: at most kMaxFaces faces, finite coordinates,
    /// indices in range. Buffers that it uses are read and kept; nothing is welded or repaired.
    [[nodiscard]] Result<SceneMesh, Refusal> read_mesh(const MeshUse& use);

private:
    struct Reader;

    Scene();

    std::filesystem::path path_;
    std::unique_ptr<Reader> reader_;
    std::vector<SceneObject> objects_;
    std::vector<std::string> notes_;
};

} // namespace tactus
