// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/scene/scene_mesh.hpp"
#include "host_tools/scene/scene_object.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace tactus
{

/// Whether a path ends in .gltf or .glb, in either case of letters.
[[nodiscard]] bool has_scene_extension(const std::filesystem::path& path);

/// A glTF 2.0 scene (docs/scene-files.md): its objects, and the meshes that they show. Every
/// refusal is one line that begins with the file's name.
class Scene
{
public:
    /// Reads .gltf and .glb: 1 to kMaxObjects objects, one of them touched at least. Costs the
    /// file's bytes and some 100 bytes for each value of its JSON, which are bounded, too; of the
    /// buffers only those are read that say where instances stand.
    [[nodiscard]] static Result<Scene, Refusal> open(const std::filesystem::path& path);

    ~Scene();
    Scene(Scene&&) noexcept;
    Scene& operator=(Scene&&) noexcept;

    /// In the order of the file's nodes.
    [[nodiscard]] const std::vector<SceneObject>& objects() const noexcept { return objects_; }

    /// What of the file is left out or can't be told, one line each: hidden nodes, and what
    /// extensions add, move or hide.
    [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

    /// What a modeller called the mesh, as a valid name; not unique. "mesh7" where it has none.
    [[nodiscard]] std::string mesh_name(const MeshUse& use) const;

    /// The same for messages: mesh 'arm' (meshes[7]).
    [[nodiscard]] std::string mesh_place(const MeshUse& use) const;

    /// The mesh of an object, in the object's frame: at most kMaxFaces faces, finite coordinates,
    /// indices in range. Buffers that it lies in are read and kept; nothing is welded or repaired.
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
