// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/spm_build/build_model.hpp"
#include "host_tools/spm_build/placing.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace tactus::spm_build
{

/// A model of a scene.
struct SceneModel
{
    std::string name; ///< Of its file, without ".spm".
    std::size_t objects{0};
    Outcome outcome;
    std::vector<std::string> notes;
};

/// What was made, for the summary.
struct SceneOutcome
{
    std::filesystem::path file; ///< The scene's.
    std::size_t objects{0};
    std::vector<SceneModel> models;
    std::vector<std::string> notes; ///< What of the scene is left out.
};

/// Makes the models of a glTF scene's meshes in `folder`, each of different meshes once, without
/// objects that have no surface, and the scene file scene.gltf beside them, which names them
/// (docs/scene-files.md). All meshes are read before anything is written. Until all models are made
/// nothing in the folder changes; then they take their places, and the scene file comes last. After
/// a refusal nothing new is there, unless the disk fails between these. A signal may leave a folder
/// PID.partial in it.
[[nodiscard]] Result<SceneOutcome, Refusal> build_scene(const std::filesystem::path& input,
                                                        const std::filesystem::path& folder,
                                                        const ModelOptions& options,
                                                        const Placing& placing);

} // namespace tactus::spm_build
