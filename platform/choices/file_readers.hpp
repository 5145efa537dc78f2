// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/math/similarity.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/material.hpp"
#include "transport/base/refusal.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace tactus::hrtc
{

/// Object that is in the scene from the start.
struct PlacedObject
{
    std::size_t model{0}; ///< Index of its model in Options::models.
    Similarity place;
    Material material;
    bool has_place{false}; ///< True if --place or the server has given the place.
    bool has_material{false};
    std::string name; ///< Name in its scene; empty: none.
};

/// Contents of a scene file.
struct SceneFile
{
    std::vector<std::string> models; ///< Paths of the models; each once.
    std::vector<PlacedObject> objects;
    std::vector<std::string> notes; ///< Notes on the parts of the file that were ignored.
};

/// Functions that recognise and read mesh and scene files. The program sets them. The defaults
/// recognise no file and refuse to read. Any thread.
struct FileReaders
{
    /// True if a file of this name is a mesh.
    bool (*is_mesh_name)(const std::string& path){[](const std::string&) { return false; }};
    /// True if a file of this name is a scene.
    bool (*is_scene_name)(const std::string& path){[](const std::string&) { return false; }};
    /// Message for a mesh file given as a model.
    std::string (*mesh_is_no_model)(const std::string& path){[](const std::string& path)
                                                             { return path; }};
    /// Reads the corners of a mesh, as in its file.
    Result<std::vector<Vec3>, Refusal> (*read_corners)(const std::string& path){no_corners};
    /// Reads a scene. The models of its objects must exist as files already.
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
