// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/scene/detail/gltf_file.hpp"
#include "host_tools/scene/scene_mesh.hpp"

#include <cstddef>
#include <cstdint>

namespace tactus::detail
{

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
