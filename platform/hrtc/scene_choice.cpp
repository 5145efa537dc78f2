// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/scene_choice.hpp"

#include "host_tools/scene/placed_models.hpp"
#include "platform/hrtc/messages.hpp"
#include "platform/hrtc/object_pose.hpp"
#include "rt_core/limits.hpp"

#include <fmt/format.h>

namespace tactus::hrtc
{

std::optional<Refusal> take_scene(Options& options)
{
    if (options.scene_path.empty())
    {
        return std::nullopt;
    }
    const auto scene = read_placed_models(options.scene_path);
    if (!scene)
    {
        return failure("--scene: " + scene.error().text);
    }
    const PlacedModels& placed = scene.value();
    if (placed.files.size() > kMaxModels)
    {
        return failure(fmt::format("--scene: {}: {} models; at most {}", options.scene_path,
                                   placed.files.size(), kMaxModels));
    }
    if (options.objects_max != 0 && options.objects_max < placed.objects.size())
    {
        return failure(fmt::format("--objects: {}; {} are there from the start",
                                   options.objects_max, placed.objects.size()));
    }
    for (const auto& file : placed.files)
    {
        options.models.push_back(file.string());
    }
    for (const PlacedModel& object : placed.objects)
    {
        options.objects.push_back({object.model, to_similarity(object.pose), object.material});
    }
    return std::nullopt;
}

} // namespace tactus::hrtc
