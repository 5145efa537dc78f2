// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/readers/file_readers.hpp"

#include "host_tools/mesh/read_mesh.hpp"
#include "host_tools/scene/placed_models.hpp"
#include "host_tools/scene/scene.hpp"
#include "platform/scene/scene_parts.hpp"

#include <utility>

namespace tactus::hrtc
{

namespace
{

Result<std::vector<Vec3>, Refusal> read_corners(const std::string& path)
{
    const auto mesh = read_mesh(path);
    if (!mesh)
    {
        return mesh.error();
    }
    std::vector<Vec3> corners;
    for (const auto& p : mesh.value().positions)
    {
        corners.emplace_back(p[0], p[1], p[2]);
    }
    return corners;
}

Result<SceneFile, Refusal> read_scene_file(const std::string& path)
{
    auto placed = read_placed_models(path);
    if (!placed)
    {
        return placed.error();
    }
    SceneFile scene;
    for (const auto& file : placed.value().files)
    {
        scene.models.push_back(file.string());
    }
    for (const PlacedModel& object : placed.value().objects)
    {
        scene.objects.push_back({.model = object.model,
                                 .place = to_similarity(object.pose),
                                 .material = object.material,
                                 .name = object.name});
    }
    scene.notes = std::move(placed).value().notes;
    return scene;
}

} // namespace

FileReaders file_readers()
{
    FileReaders readers;
    readers.is_mesh_name = [](const std::string& path) { return is_mesh_file_name(path); };
    readers.is_scene_name = [](const std::string& path) { return has_scene_extension(path); };
    readers.mesh_is_no_model = [](const std::string& path) { return mesh_is_no_model(path); };
    readers.read_corners = read_corners;
    readers.read_scene = read_scene_file;
    return readers;
}

} // namespace tactus::hrtc
