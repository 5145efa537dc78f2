// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/scene_choice.hpp"

#include "host_tools/scene/placed_models.hpp"
#include "platform/hrtc/messages.hpp"
#include "platform/hrtc/object_pose.hpp"
#include "platform/hrtc/scene_room.hpp"
#include "rt_core/limits.hpp"
#include "transport/content_hash.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

namespace tactus::hrtc
{

namespace
{

constexpr std::chrono::milliseconds kPause{2};

/// What the host shows by now, as far as it serves the models. None yet: why.
std::optional<std::string> take_objects(Options& options, std::vector<HostObject>& shown,
                                        const dds::Catalogue& catalogue, dds::SceneReader& reader)
{
    const auto host = catalogue.find_scene(options.scene);
    if (!host)
    {
        return fmt::format("is not shown on domain {} (scenes there: {})", options.domain,
                           catalogue.scene_names());
    }
    reader.poll({&*host, 1}, [](dds::SceneNews /*news*/, const dds::SeenObject& /*object*/) {});
    if (!reader.is_complete(*host))
    {
        return fmt::format("is there on domain {}, but not all its objects have come{}{}",
                           options.domain, reader.fault().empty() ? "" : "; ", reader.fault());
    }
    const std::vector<const dds::Catalogue::Offer*> offers = catalogue.offers_of(*host);
    options.models.clear();
    for (const dds::Catalogue::Offer* offer : offers)
    {
        options.models.push_back(offer->name + "@" + hash_text(offer->hash));
    }
    options.objects.clear();
    shown.clear();
    for (const auto& [number, object] : reader.objects(*host))
    {
        const auto offer =
            std::ranges::find(offers, object.shown.model, &dds::Catalogue::Offer::hash);
        if (offer != offers.end()) // Otherwise the keeper names it in the run.
        {
            options.objects.push_back({static_cast<std::size_t>(offer - offers.begin()),
                                       to_similarity(object.shown.pose), object.shown.material});
            shown.push_back({*host, number});
        }
    }
    return options.objects.empty()
               ? std::optional(fmt::format("shows no object of a model that its host serves on "
                                           "domain {}",
                                           options.domain))
               : std::nullopt;
}

std::optional<Refusal> check_counts(const Options& options)
{
    if (options.models.size() > kMaxModels)
    {
        return failure(fmt::format("--scene: {}: {} models; at most {}", options.scene,
                                   options.models.size(), kMaxModels));
    }
    if (options.objects_max != 0 && options.objects_max < options.objects.size())
    {
        return failure(fmt::format("--objects: {}; {} are there from the start",
                                   options.objects_max, options.objects.size()));
    }
    return std::nullopt;
}

} // namespace

std::optional<Refusal> take_scene_file(Options& options)
{
    const auto scene = read_placed_models(options.scene);
    if (!scene)
    {
        return failure("--scene: " + scene.error().text);
    }
    const PlacedModels& placed = scene.value();
    for (const auto& file : placed.files)
    {
        options.models.push_back(file.string());
    }
    for (const PlacedModel& object : placed.objects)
    {
        options.objects.push_back({object.model, to_similarity(object.pose), object.material});
    }
    return check_counts(options);
}

Result<ShownScene, Refusal> take_shown_scene(Options& options, dds::DdsClient& client,
                                             dds::SceneReader& reader,
                                             const std::function<bool()>& goes_on)
{
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    const std::chrono::duration<double> longest(options.wait_s);
    ShownScene scene{options.scene, {}};
    for (;;)
    {
        client.exchange().step();
        const auto missing = take_objects(options, scene.objects, client.catalogue(), reader);
        if (!missing)
        {
            break;
        }
        const std::chrono::duration<double> waited = Clock::now() - start;
        if (waited >= longest || !goes_on())
        {
            return failure(fmt::format("--scene: '{}' {}; waited {:.3g} s", options.scene, *missing,
                                       waited.count()));
        }
        std::this_thread::sleep_for(kPause);
    }
    if (const auto refusal = check_counts(options))
    {
        return *refusal;
    }
    if (options.objects_max == 0)
    {
        options.objects_max = std::max(SceneRoom::of(options.pool_bytes()).objects,
                                       static_cast<std::uint32_t>(options.objects.size()));
    }
    return scene;
}

} // namespace tactus::hrtc
