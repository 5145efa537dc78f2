// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/run_options.hpp"
#include "transport/base/refusal.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/dds/scene_reader.hpp"
#include "transport/served_model.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::hrtc
{

/// An object as its host knows it.
struct HostObject
{
    std::uint64_t host_epoch{0};
    std::uint32_t number{0};

    auto operator<=>(const HostObject&) const noexcept = default;
};

/// A scene that a host shows.
struct ShownScene
{
    std::string name;
    std::uint64_t host_epoch{0};
    std::vector<HostObject> objects; ///< In the order of Options::objects.
    SceneMaterials materials;        ///< That go before the host's.
};

/// Reads the scene file that the options name and puts its models and objects in their places.
/// Returns why it can't be used.
[[nodiscard]] std::optional<Refusal> take_scene_file(Options& options);

/// Waits, at most Options::wait_s and as long as `goes_on`, until a host whose scene the options
/// name has shown all its objects to `reader`, and one at least is there: the first that has, and
/// of those that have the one that was seen first. Puts its objects in their places and all models
/// that it serves, so that later objects find theirs. Returns why there are none.
[[nodiscard]] Result<ShownScene, Refusal> take_shown_scene(Options& options, dds::DdsClient& client,
                                                           dds::SceneReader& reader,
                                                           const std::function<bool()>& goes_on);

/// Waits a moment for what the models' hosts show, and puts the first object of each model where
/// its host has the first one that shows it, under that one's name. The others stay where they are.
void take_first_places(Options& options, std::span<const ServedModel> models,
                       dds::DdsClient& client, dds::SceneReader& reader,
                       const std::function<bool()>& goes_on);

} // namespace tactus::hrtc
