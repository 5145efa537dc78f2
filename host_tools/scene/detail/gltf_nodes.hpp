// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/scene/detail/gltf_file.hpp"
#include "host_tools/scene/scene_object.hpp"

#include <vector>

namespace tactus::detail
{

/// A million nodes are no scene for hands; the rest of a file may be as large as it likes.
inline constexpr std::size_t kMaxNodes = 65'536;

/// What of the file's scene is an object: each node of it with a mesh, or with a model in
/// `extras.tactus`, in the order of the file's nodes; up to kMaxObjects, with names of their own.
/// Every rule about nodes is checked here; meshes are not looked at. Throws a SceneFault that names
/// the node. Linear in the nodes; nothing recurses.
[[nodiscard]] std::vector<SceneObject> read_objects(const GltfFile& file);

} // namespace tactus::detail
