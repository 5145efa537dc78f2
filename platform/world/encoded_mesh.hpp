// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/world/world_parts.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstddef>
#include <filesystem>
#include <string>

namespace tactus::hrtc
{

/// Folder of a World's encoded meshes, made when it is needed and removed with the object.
class MeshFolder
{
public:
    MeshFolder() = default;
    MeshFolder(const MeshFolder&) = delete;
    MeshFolder& operator=(const MeshFolder&) = delete;
    ~MeshFolder();

    /// Encodes a mesh of a file or in memory as a model, as spm_build does without further options.
    /// Returns its path. Refused for what spm_build refuses, for a name that is not valid, and for
    /// a progress callback that throws.
    [[nodiscard]] Result<std::string, Refusal> encode(const WorldModel& model);

private:
    [[nodiscard]] Result<std::filesystem::path, Refusal> file_for(const std::string& name);

    std::filesystem::path folder_; ///< Empty before the first mesh.
    std::size_t count_{0};
};

} // namespace tactus::hrtc
