// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/placed_object.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/math/vec3.hpp"
#include "transport/base/refusal.hpp"

#include <string>
#include <vector>

namespace tactus::hrtc
{

/// Contents of a scene file.
struct SceneFile
{
    std::vector<std::string> models; ///< Paths of the models; each once.
    std::vector<PlacedObject> objects;
    std::vector<std::string> notes; ///< Notes on parts of the file that are not read.
};

/// Detection and readers of the files of graphics stations. The controller has none of its own; its
/// program supplies them. Without them, no file counts as a mesh or a scene. Any thread.
struct FileReaders
{
    /// True if a file of this name is a mesh.
    bool (*is_mesh_name)(const std::string& path){[](const std::string&) { return false; }};
    /// True if a file of this name is a scene.
    bool (*is_scene_name)(const std::string& path){[](const std::string&) { return false; }};
    /// Refusal of a mesh in the place of a model.
    std::string (*mesh_is_no_model)(const std::string& path){[](const std::string& path)
                                                             { return path; }};
    /// Corners of a mesh, as in its file.
    Result<std::vector<Vec3>, Refusal> (*read_corners)(const std::string& path){no_corners};
    /// Scene whose objects show models that already exist.
    Result<SceneFile, Refusal> (*read_scene)(const std::string& path){no_scene};

private:
    static Result<std::vector<Vec3>, Refusal> no_corners(const std::string& path)
    {
        return Refusal{path + ": this program reads no meshes"};
    }
    static Result<SceneFile, Refusal> no_scene(const std::string& path)
    {
        return Refusal{path + ": this program reads no scenes"};
    }
};

} // namespace tactus::hrtc
