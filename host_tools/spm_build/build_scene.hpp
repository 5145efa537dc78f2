// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/build/build_model.hpp"
#include "host_tools/spm_build/placing.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace tactus::spm_build
{

struct SceneModel
{
    std::string name; ///< Name of its file, without ".spm".
    std::size_t objects{0};
    BuiltModel outcome;
    std::vector<std::string> notes;
};

/// Figures of a built scene, for the summary.
struct SceneOutcome
{
    std::filesystem::path file; ///< Scene file.
    std::size_t objects{0};
    std::vector<SceneModel> models;
    std::vector<std::string> notes; ///< Notes on ignored content of the scene.
};

/// Builds in `folder` one model for each different mesh of a glTF scene, and the scene file
/// scene.gltf, which names the models (docs/scene-files.md). Objects without a surface are ignored.
/// All meshes are read before anything is written. Nothing in the folder changes until all models
/// are built; then they are moved into place, and the scene file last. A refusal leaves nothing
/// new, unless the disk fails between these moves. A signal may leave a folder PID.partial in
/// `folder`.
[[nodiscard]] Result<SceneOutcome, Refusal> build_scene(const std::filesystem::path& input,
                                                        const std::filesystem::path& folder,
                                                        const ModelOptions& options,
                                                        const Placing& placing);

} // namespace tactus::spm_build
