// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/scene/detail/gltf_file.hpp"
#include "host_tools/scene/left_out.hpp"
#include "host_tools/scene/scene_object.hpp"

#include <vector>

namespace tactus::detail
{

/// A million nodes are no scene for hands; the rest of a file may be as large as it likes.
inline constexpr std::size_t kMaxNodes = 65'536;

/// What of the file's scene is an object: each node of it with a mesh, or with a model in
/// `extras.tactus`, in the order of the file's nodes, and each instance of such a node; up to
/// kMaxObjects, with names of their own. `left_out` gets what is hidden, a lower level of detail or
/// scaled to nothing. Every rule about nodes that count is checked here; meshes are not looked at.
/// Throws a SceneFault that names the node. Linear in the nodes; nothing recurses.
[[nodiscard]] std::vector<SceneObject> read_objects(GltfFile& file, LeftOut& left_out);

} // namespace tactus::detail
