// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/object_pose.hpp"
#include "transport/pose.hpp"

#include <compare>
#include <cstddef>
#include <optional>
#include <string>

namespace tactus
{

/// A mesh of a scene file as an object shows it. A node that mirrors shows another shape than its
/// mesh, which no pose can make of it.
struct MeshUse
{
    std::size_t mesh{0};     ///< Of the file's meshes.
    bool is_mirrored{false}; ///< At the plane x = 0 of the mesh's frame.

    [[nodiscard]] auto operator<=>(const MeshUse&) const = default;
};

/// A node of a scene file that is an object.
struct SceneObject
{
    std::string name;            ///< Valid, and no other object's.
    std::string place;           ///< The node, for messages: node 'Arm' (nodes[3]).
    std::string model;           ///< An .spm beside the scene file; empty: none is named.
    std::optional<MeshUse> mesh; ///< None: a model is named instead.
    Pose pose;                   ///< In the world, in metres; one that checked_pose() takes.
    Material material;
    bool is_touched{true}; ///< False: hands go through, and the rest needn't be fit for them.
};

} // namespace tactus
