// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/scene/scene_object.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace tactus
{

/// An object that shows a model.
struct PlacedModel
{
    std::string name;     ///< Name; valid and unique.
    std::size_t model{0}; ///< Index into PlacedModels::files.
    Pose pose;
    Material material;
};

/// A scene whose objects show existing models, as spm_publish serves it and hrtc touches it without
/// a server.
struct PlacedModels
{
    std::vector<std::filesystem::path> files; ///< Files, each once, in order of appearance.
    std::vector<PlacedModel> objects;         ///< Touched objects, 1 to kMaxObjects.
    std::vector<std::string> notes;           ///< Notes on content of the file that is ignored.
};

/// Reads a scene file in which each touched object names its model, as spm_build writes it. The
/// existence of the models is not checked. A refusal is one line that begins with the file's name.
[[nodiscard]] Result<PlacedModels, Refusal> read_placed_models(const std::filesystem::path& path);

/// Text of such a file: each object with name, pose, material and model. Only the names of `files`
/// are used, without folders.
[[nodiscard]] std::string scene_text(const PlacedModels& scene);

} // namespace tactus
