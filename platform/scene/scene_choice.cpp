// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/scene/scene_choice.hpp"

#include "platform/choices/messages.hpp"
#include "platform/choices/run_options.hpp"
#include "platform/machine/clock.hpp"
#include "platform/scene/scene_parts.hpp"
#include "rt_core/limits.hpp"
#include "transport/base/program_log.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/dds/scene_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <thread>
#include <utility>

namespace tactus::hrtc
{

namespace
{

constexpr std::chrono::milliseconds kPause{2};

/// Longest wait for the objects of servers without a scene; a server may have none.
constexpr std::chrono::seconds kPlacesMax{3};

/// Largest number of servers considered at once; only an attack could exceed it.
constexpr std::size_t kMaxCandidates = 256;

/// Sets the options' models to all that the scene's server serves, and the objects to those with
/// such a model.
void take_objects(Options& options, ShownScene& scene, const dds::Catalogue& catalogue,
                  const dds::SceneReader& reader)
{
    const std::vector<const dds::Catalogue::Offer*> offers =
        catalogue.offers_of(scene.server_epoch);
    options.models.clear();
    for (const dds::Catalogue::Offer* offer : offers)
    {
        options.models.push_back(offer->name + "@" + hash_text(offer->hash));
    }
    options.objects.clear();
    scene.objects.clear();
    for (const auto& [number, object] : reader.objects(scene.server_epoch))
    {
        const auto offer =
            std::ranges::find(offers, object.shown.model, &dds::Catalogue::Offer::hash);
        if (offer != offers.end()) // SceneKeeper logs the others during the run.
        {
            const ShownObject& shown = object.shown;
            options.objects.push_back(
                {.model = static_cast<std::size_t>(offer - offers.begin()),
                 .place = to_similarity(shown.pose),
                 .material = options.scene_materials.material_for(shown.name, shown.material),
                 .name = shown.name});
            scene.objects.push_back({scene.server_epoch, number});
        }
    }
}

/// Takes the scene of the first server that has shown all its objects. If there is none yet,
/// returns the reason.
std::optional<std::string> try_take(Options& options, const ModelSelector& selector,
                                    ShownScene& scene, const dds::Catalogue& catalogue,
                                    dds::SceneReader& reader)
{
    std::vector<std::uint64_t> servers;
    for (const dds::Catalogue::Offer* offer : catalogue.servers_of_scene(selector))
    {
        if (servers.size() < kMaxCandidates)
        {
            servers.push_back(offer->server_epoch);
        }
    }
    reader.poll(servers, [](dds::SceneNews /*news*/, const dds::SeenObject& /*object*/) {});
    for (const std::uint64_t server : servers)
    {
        if (reader.is_complete(server) && !reader.objects(server).empty())
        {
            scene.server_epoch = server;
            take_objects(options, scene, catalogue, reader);
            if (!options.objects.empty())
            {
                return std::nullopt;
            }
        }
    }
    if (servers.empty())
    {
        return fmt::format("is not shown on domain {} (scenes there: {})", options.domain,
                           catalogue.scene_names());
    }
    return std::ranges::all_of(servers,
                               [&](std::uint64_t server) { return reader.is_complete(server); })
               ? fmt::format("has no object with a model that its server serves on domain {}",
                             options.domain)
               : fmt::format("is on domain {}, but not all of its objects have arrived{}{}",
                             options.domain, reader.fault().empty() ? "" : "; ", reader.fault());
}

std::vector<std::string> names_of(const Options& options)
{
    std::vector<std::string> names;
    std::ranges::transform(options.objects, std::back_inserter(names), &PlacedObject::name);
    return names;
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
        return failure(fmt::format("--objects: {} is less than the {} objects at the start",
                                   options.objects_max, options.objects.size()));
    }
    return std::nullopt;
}

} // namespace

std::optional<Refusal> take_scene_file(Options& options)
{
    auto scene = options.readers.read_scene(options.scene);
    if (!scene)
    {
        return failure("--scene: " + scene.error().text);
    }
    SceneFile placed = std::move(scene).value();
    for (const std::string& note : placed.notes)
    {
        log_message(LogLevel::info, "hrtc", "note: " + note);
    }
    const std::size_t before = options.models.size(); // Mesh tools of a World.
    std::ranges::move(placed.models, std::back_inserter(options.models));
    for (PlacedObject& object : placed.objects)
    {
        object.model += before;
        object.material = options.scene_materials.material_for(object.name, object.material);
        options.objects.push_back(std::move(object));
    }
    if (std::string fault = options.scene_materials.missing(names_of(options)); !fault.empty())
    {
        return failure(std::move(fault));
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
    ShownScene scene{selector.name, 0, {}, options.scene_materials};
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
            const auto why = client.catalogue().scene_names() == "none"
                                 ? dds::why_unheard(client.domain().id())
                                 : std::nullopt;
            return failure(fmt::format("--scene: '{}' {}{}; waited {:.3g} s", options.scene,
                                       *missing, why ? "; " + *why : "", waited.count()));
        }
        std::this_thread::sleep_for(kPause);
    }
    if (const auto refusal = check_counts(options))
    {
        return *refusal;
    }
    if (const std::string line = options.scene_materials.missing(names_of(options)); !line.empty())
    {
        log_message(LogLevel::info, "hrtc",
                    "note: " + line + "; an object added later with this name gets the material");
    }
    if (options.objects_max == 0)
    {
        options.objects_max = std::max(SceneRoom::of(options.pool_bytes()).objects,
                                       static_cast<std::uint32_t>(options.objects.size()));
    }
    return scene;
}

void take_first_places(Options& options, std::span<const ServedModel> models,
                       dds::DdsClient& client, dds::SceneReader& reader,
                       const std::function<bool()>& goes_on)
{
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    std::vector<std::uint64_t> servers;
    for (const ServedModel& model : models)
    {
        if (std::ranges::find(servers, model.server_epoch) == servers.end())
        {
            servers.push_back(model.server_epoch);
        }
    }
    const auto is_complete = [&](std::uint64_t server) { return reader.is_complete(server); };
    while (!std::ranges::all_of(servers, is_complete) && Clock::now() - start < kPlacesMax &&
           goes_on())
    {
        client.exchange().step();
        reader.poll(servers, [](dds::SceneNews /*news*/, const dds::SeenObject& /*object*/) {});
        std::this_thread::sleep_for(kPause);
    }
    for (std::size_t i = 0; i < models.size(); ++i)
    {
        const auto& shown = reader.objects(models[i].server_epoch);
        const auto first = std::ranges::find_if(
            shown, [&](const auto& entry) { return entry.second.shown.model == models[i].hash; });
        const auto ours = std::ranges::find(options.objects, i, &PlacedObject::model);
        if (first != shown.end() && ours != options.objects.end())
        {
            ours->place = to_similarity(first->second.shown.pose);
            ours->has_place = true;
            ours->name = first->second.shown.name;
        }
    }
}

} // namespace tactus::hrtc
