// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/scene/detail/gltf_file.hpp"
#include "host_tools/scene/scene_names.hpp"
#include "host_tools/scene/scene_object.hpp"

#include <cstddef>
#include <cstdint>
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

/// Limit of the accessor elements that all meshes of a file read: kReadsPerByte for each byte of
/// the buffers read so far, plus kFreeReads. Meshes may share accessors, and a small file must not
/// expand to gigabytes of triangles.
inline constexpr std::uint64_t kReadsPerByte = 64;
inline constexpr std::uint64_t kFreeReads = 1'000'000;

/// Reads the meshes of one file; functions throw a SceneFault that names the mesh.
class GltfMeshes
{
public:
    /// `file` must outlive the object.
    explicit GltfMeshes(GltfFile& file) : file_(file) {}

    /// All triangles of meshes[index], with the positions that they use, in the mesh's own frame.
    [[nodiscard]] SceneMesh read(std::size_t index);

private:
    void charge(std::uint64_t reads, const JsonAt& primitive);

    GltfFile& file_;
    std::uint64_t reads_{0}; ///< Elements read by all meshes so far.
};

} // namespace tactus::detail
