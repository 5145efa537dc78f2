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

/// Hosts that are asked at the same time; only strangers could be so many.
constexpr std::size_t kMaxCandidates = 256;

/// What the host shows, as far as it serves the models.
void take_objects(Options& options, ShownScene& scene, const dds::Catalogue& catalogue,
                  const dds::SceneReader& reader)
{
    const std::vector<const dds::Catalogue::Offer*> offers = catalogue.offers_of(scene.host_epoch);
    options.models.clear();
    for (const dds::Catalogue::Offer* offer : offers)
    {
        options.models.push_back(offer->name + "@" + hash_text(offer->hash));
    }
    options.objects.clear();
    scene.objects.clear();
    for (const auto& [number, object] : reader.objects(scene.host_epoch))
    {
        const auto offer =
            std::ranges::find(offers, object.shown.model, &dds::Catalogue::Offer::hash);
        if (offer != offers.end()) // Otherwise the keeper names it in the run.
        {
            options.objects.push_back({static_cast<std::size_t>(offer - offers.begin()),
                                       to_similarity(object.shown.pose), object.shown.material});
            scene.objects.push_back({scene.host_epoch, number});
        }
    }
}

/// Of the first host that has shown all by now. None yet: why.
std::optional<std::string> try_take(Options& options, const ModelSelector& selector,
                                    ShownScene& scene, const dds::Catalogue& catalogue,
                                    dds::SceneReader& reader)
{
    std::vector<std::uint64_t> hosts;
    for (const dds::Catalogue::Offer* offer : catalogue.servers_of_scene(selector))
    {
        if (hosts.size() < kMaxCandidates)
        {
            hosts.push_back(offer->host_epoch);
        }
    }
    reader.poll(hosts, [](dds::SceneNews /*news*/, const dds::SeenObject& /*object*/) {});
    for (const std::uint64_t host : hosts)
    {
        if (reader.is_complete(host) && !reader.objects(host).empty())
        {
            scene.host_epoch = host;
            take_objects(options, scene, catalogue, reader);
            if (!options.objects.empty())
            {
                return std::nullopt;
            }
        }
    }
    if (hosts.empty())
    {
        return fmt::format("is not shown on domain {} (scenes there: {})", options.domain,
                           catalogue.scene_names());
    }
    return std::ranges::all_of(hosts, [&](std::uint64_t host) { return reader.is_complete(host); })
               ? fmt::format("shows no object of a model that its host serves on domain {}",
                             options.domain)
               : fmt::format("is there on domain {}, but not all its objects have come{}{}",
                             options.domain, reader.fault().empty() ? "" : "; ", reader.fault());
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
    const ModelSelector selector = parse_selector(options.scene).value();
    client.catalogue().ask_for_scene(selector.name);
    ShownScene scene{selector.name, 0, {}};
    for (;;)
    {
        client.exchange().step();
        const auto missing = try_take(options, selector, scene, client.catalogue(), reader);
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
