// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/scene_materials.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <compare>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus
{

struct ServedModel;

} // namespace tactus

namespace tactus::dds
{

class DdsClient;
class SceneReader;

} // namespace tactus::dds

namespace tactus::hrtc
{

struct Options;

/// Identity of an object at its server.
struct ServerObject
{
    std::uint64_t server_epoch{0};
    std::uint32_t number{0};

    auto operator<=>(const ServerObject&) const noexcept = default;
};

/// Scene of a server, as the controller shows it.
struct ShownScene
{
    std::string name;
    std::uint64_t server_epoch{0};
    std::vector<ServerObject> objects; ///< Objects in the order of Options::objects.
    SceneMaterials materials;          ///< Materials that override the server's.
};

/// Reads the scene file named in the options, and adds its models and objects to them. Returns the
/// reason if the file can't be used.
[[nodiscard]] std::optional<Refusal> take_scene_file(Options& options);

/// Waits until a server of the named scene has shown all its objects to `reader`, at least one; of
/// several such servers takes the first. Waits at most Options::wait_s and while `goes_on` returns
/// true. Sets the options' objects to the server's, and the models to all that the server serves,
/// since later objects may need any of them. Returns the reason if there is no such server.
[[nodiscard]] Result<ShownScene, Refusal> take_shown_scene(Options& options, dds::DdsClient& client,
                                                           dds::SceneReader& reader,
                                                           const std::function<bool()>& goes_on);

/// Waits at most 3 s for the objects of the models' servers. Moves the first object of each model
/// to the server's first object with that model, and takes its name. Other objects stay.
void take_first_places(Options& options, std::span<const ServedModel> models,
                       dds::DdsClient& client, dds::SceneReader& reader,
                       const std::function<bool()>& goes_on);

} // namespace tactus::hrtc
