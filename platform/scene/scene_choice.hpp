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

/// Identity of an object at its host.
struct HostObject
{
    std::uint64_t host_epoch{0};
    std::uint32_t number{0};

    auto operator<=>(const HostObject&) const noexcept = default;
};

struct ShownScene
{
    std::string name;
    std::uint64_t host_epoch{0};
    std::vector<HostObject> objects; ///< Objects in the order of Options::objects.
    SceneMaterials materials;        ///< Materials that override the host's.
};

/// Reads the scene file named in the options and sets its models and objects. Returns the reason if
/// it can't be used.
[[nodiscard]] std::optional<Refusal> take_scene_file(Options& options);

/// Waits, at most Options::wait_s and while `goes_on`, until a host of the named scene has shown
/// all its objects to `reader`, at least one; of several hosts, the one seen first. Sets its
/// objects and all models that it serves, so that later objects find theirs. Returns the reason if
/// there are none.
[[nodiscard]] Result<ShownScene, Refusal> take_shown_scene(Options& options, dds::DdsClient& client,
                                                           dds::SceneReader& reader,
                                                           const std::function<bool()>& goes_on);

/// Waits shortly for the objects of the models' hosts. Moves the first object of each model to the
/// first one that its host shows, and takes its name. The others are unchanged.
void take_first_places(Options& options, std::span<const ServedModel> models,
                       dds::DdsClient& client, dds::SceneReader& reader,
                       const std::function<bool()>& goes_on);

} // namespace tactus::hrtc
