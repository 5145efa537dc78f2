// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/scene.hpp"

#include "host_tools/scene/detail/gltf_nodes.hpp"
#include "host_tools/scene/scene_names.hpp"
#include "rt_core/base/assert.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <new>
#include <utility>

namespace tactus
{

namespace
{

/// Result of `read`. A SceneFault becomes a refusal that begins with the file's name.
template <typename Read>
auto refusing(const std::filesystem::path& path, const Read& read)
    -> Result<decltype(read()), Refusal>
{
    try
    {
        return read();
    }
    catch (const detail::SceneFault& fault)
    {
        return Refusal{fmt::format("{}: {}", path.string(), fault.text)};
    }
    catch (const std::bad_alloc&)
    {
        return Refusal{fmt::format("{}: there is not enough memory to read it", path.string())};
    }
}

void mirror(TriangleMesh& mesh)
{
    for (auto& position : mesh.positions)
    {
        position[0] = -position[0];
    }
    for (auto& face : mesh.faces)
    {
        std::swap(face[1], face[2]); // Reversed, so that faces keep their outside.
    }
}

} // namespace

struct Scene::Reader
{
    explicit Reader(const std::filesystem::path& path) : file(path), meshes(file) {}

    detail::GltfFile file;
    detail::GltfMeshes meshes;
};

bool has_scene_extension(const std::filesystem::path& path)
{
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](char c)
                           { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return extension == ".gltf" || extension == ".glb";
}

Scene::Scene() = default;
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

Result<Scene, Refusal> Scene::open(const std::filesystem::path& path)
{
    return refusing(
        path,
        [&]
        {
            Scene scene;
            scene.path_ = path;
            scene.reader_ = std::make_unique<Reader>(path);
            LeftOut left_out;
            scene.objects_ = detail::read_objects(scene.reader_->file, left_out);
            scene.notes_ = left_out.notes();
            if (std::ranges::none_of(scene.objects_, &SceneObject::is_touched))
            {
                throw detail::SceneFault{
                    !scene.objects_.empty()
                        ? "every object is excluded by extras.tactus.touch = false"
                    : scene.notes_.empty() ? "its scene has no node with a mesh or a model"
                                           : "no object is left to touch: " + scene.notes_.front()};
            }
            std::ranges::copy(scene.reader_->file.notes(), std::back_inserter(scene.notes_));
            return scene;
        });
}

std::string Scene::mesh_name(const MeshUse& use) const
{
    const std::string name = reader_->file.root().at("meshes").at(use.mesh).name();
    return name.empty() ? "mesh" + std::to_string(use.mesh) : plain_name(name);
}

std::string Scene::mesh_place(const MeshUse& use) const
{
    return reader_->file.described("meshes", use.mesh);
}

Result<SceneMesh, Refusal> Scene::read_mesh(const MeshUse& use)
{
    return refusing(path_,
                    [&]
                    {
                        SceneMesh mesh = reader_->meshes.read(use.mesh);
                        if (use.is_mirrored)
                        {
                            mirror(mesh.mesh);
                        }
                        return mesh;
                    });
}

} // namespace tactus
