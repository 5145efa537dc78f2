// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"
#include "rt_core/records/object_pose.hpp"
#include "transport/pose.hpp"

#include <compare>
#include <cstddef>
#include <optional>
#include <string>

namespace tactus
{

/// Use of a scene file's mesh by an object. A node that mirrors shows another shape than its mesh,
/// and no pose can convert one into the other.
struct MeshUse
{
    std::size_t mesh{0};     ///< Index into the file's meshes.
    bool is_mirrored{false}; ///< True if mirrored at the plane x = 0 of the mesh's frame.

    [[nodiscard]] auto operator<=>(const MeshUse&) const = default;
};

/// A node of a scene file that is an object.
struct SceneObject
{
    std::string name;  ///< Name; valid (is_valid_name) and unique in the scene.
    std::string place; ///< Description of the node for messages: node 'Arm' (nodes[3]).
    std::string model; ///< Name of an .spm file beside the scene file; empty if none is named.
    std::optional<MeshUse> mesh; ///< Mesh; none if a model is named instead.
    Pose pose;                   ///< Pose in the world, in metres; one that checked_pose() accepts.
    Material material;
    /// False if tools pass through the object; its other members may then be invalid for a touched
    /// object.
    bool is_touched{true};
};

/// A mesh of a scene file.
struct SceneMesh
{
    TriangleMesh mesh; ///< Mesh; without faces if no part has a surface.
    /// Parts without a surface, such as "2 primitives of LINES"; empty if there are none.
    std::string left_out;
};

} // namespace tactus
