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
    std::string name;     ///< Valid, and no other object's.
    std::size_t model{0}; ///< Of PlacedModels::files.
    Pose pose;
    Material material;
};

/// A scene whose objects show models that are made already: what spm_publish serves, and hrtc
/// touches without a host.
struct PlacedModels
{
    std::vector<std::filesystem::path> files; ///< Each once, in the order in which they come up.
    std::vector<PlacedModel>
        objects;                    ///< 1 to kMaxObjects; those that hands go through aren't here.
    std::vector<std::string> notes; ///< What else of a file that was read is not here.
};

/// Reads a scene file of which each touched object names its model, as spm_build writes them.
/// Whether the models are there is not looked at. A refusal is one line that begins with the file's
/// name.
[[nodiscard]] Result<PlacedModels, Refusal> read_placed_models(const std::filesystem::path& path);

/// The text of such a file: each object with name, pose, material and model. Of files only the
/// names count.
[[nodiscard]] std::string scene_text(const PlacedModels& scene);

} // namespace tactus
