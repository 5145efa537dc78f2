// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/scene/detail/gltf_file.hpp"
#include "host_tools/scene/left_out.hpp"
#include "host_tools/scene/scene_object.hpp"

#include <vector>

namespace tactus::detail
{

/// Maximum number of nodes; no haptic scene has a million. Other parts of a file have no such
/// limit.
inline constexpr std::size_t kMaxNodes = 65'536;

/// Objects of the file's scene: each node with a mesh, or with a model in `extras.tactus`, in the
/// order of the file's nodes, and each instance of such a node; up to kMaxObjects, with unique
/// names. `left_out` receives hidden nodes, lower levels of detail and nodes scaled to nothing. All
/// rules about objects' nodes are checked here, but not meshes. Throws a SceneFault that names the
/// node. Linear in the nodes; not recursive.
[[nodiscard]] std::vector<SceneObject> read_objects(GltfFile& file, LeftOut& left_out);

} // namespace tactus::detail
