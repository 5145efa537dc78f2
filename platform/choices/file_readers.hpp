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

/// What a scene file says.
struct SceneFile
{
    std::vector<std::string> models; ///< Paths; each once.
    std::vector<PlacedObject> objects;
    std::vector<std::string> notes; ///< What else of the file is not here.
};

/// How a run knows and reads the files of graphics stations. The controller has no such reader:
/// its program lends these. Without them no file is a mesh's or a scene's. Any thread.
struct FileReaders
{
    /// Whether a file of this name is a mesh's.
    bool (*is_mesh_name)(const std::string& path){[](const std::string&) { return false; }};
    /// Whether a file of this name is a scene's.
    bool (*is_scene_name)(const std::string& path){[](const std::string&) { return false; }};
    /// The refusal of a mesh in a model's place.
    std::string (*mesh_is_no_model)(const std::string& path){[](const std::string& path)
                                                             { return path; }};
    /// The corners of a mesh, as they stand in its file.
    Result<std::vector<Vec3>, Refusal> (*read_corners)(const std::string& path){no_corners};
    /// A scene whose objects show models that are made already.
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
