// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_view/state_text.hpp"

#include "host_tools/spm_view/cut.hpp"
#include "host_tools/spm_view/feed.hpp"
#include "host_tools/web/prometheus_text.hpp"
#include "rt_core/records/work_counters.hpp"
#include "transport/content_hash.hpp"
#include "transport/telemetry_from_frame.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <vector>

namespace tactus::view
{

namespace
{

std::string why_of(std::size_t cause, std::span<const ModelTelemetry> models)
{
    std::int64_t silent_ns = 0;
    for (const ModelTelemetry& model : models)
    {
        silent_ns = std::max(silent_ns, model.server_gone ? model.pose_age_ns : 0);
    }
    const bool is_server = 1U << cause == static_cast<std::uint32_t>(ForceOff::server);
    return is_server && silent_ns > 0 ? fmt::format("the server has been silent for {:.1f} s",
                                                    static_cast<double>(silent_ns) * 1e-9)
                                      : kForceOffWords[cause].why;
}

} // namespace

std::string force_words(const RefinementStateTool& tool, const ToolTelemetry& telemetry,
                        std::span<const ModelTelemetry> models)
{
    std::string words;
    for (std::size_t cause = 0; cause < kForceOffs; ++cause)
    {
        if (has_cause(tool.causes, static_cast<ForceOff>(1U << cause)))
        {
            words += fmt::format("{}{}; returns {}",
                                 words.empty() ? "off: " : ". Also: ", why_of(cause, models),
                                 kForceOffWords[cause].back);
        }
    }
    if (!words.empty())
    {
        return words;
    }
    switch (tool.state)
    {
    case SafetyState::reset:
        return "off: the device has not been read yet; returns with the first valid sample";
    case SafetyState::brake:
        return "off: a fault has just ended; returns when the force has faded";
    case SafetyState::idle:
    case SafetyState::force:
        break;
    }
    const char* const inside =
        "the tool began inside a closed object, whose surface keeps it inside";
    return telemetry.in_contact
               ? (tool.begins_inside ? fmt::format("on: {}", inside) : "on")
               : fmt::format("on: no contact, so the force is zero{}{}",
                             tool.begins_inside ? "; " : "", tool.begins_inside ? inside : "");
}

namespace
{

using Json = nlohmann::ordered_json;

/// Name of member `i` of RefinementState::times: the stages, the frame, its CPU time.
const char* time_name(std::size_t i)
{
    constexpr std::array<const char*, 2> others{"frame", "cpu"};
    return i < kStages ? kStageNames[i] : others[i - kStages];
}

/// JSON number; null for an infinite value, which JSON cannot represent.
Json number_of(double value)
{
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

Json faults_of(std::uint32_t bits)
{
    Json names = Json::array();
    for (std::size_t i = 0; i < kFrameFaults; ++i)
    {
        if ((bits >> i & 1U) != 0)
        {
            names.push_back(kFrameFaultNames[i]);
        }
    }
    return names;
}

/// Fields of the feed, and words about the force; null without a refinement state.
Json tool_json(const LiveController& controller, std::size_t i)
{
    const Telemetry& telemetry = controller.told.telemetry;
    Json json = feed_tool(controller, i);
    json["state"] = nullptr;
    json["words"] = nullptr;
    const RefinementState* state = controller.state();
    if (state == nullptr || i >= state->tools.size())
    {
        json["shape"] = nullptr;
        json["radius_m"] = nullptr;
    }
    else if (!controller.is_recorded)
    {
        const RefinementStateTool& tool = state->tools[i];
        json["state"] = kSafetyStateNames[static_cast<std::size_t>(tool.state)];
        json["words"] = force_words(tool, telemetry.tools[i],
                                    std::span(telemetry.models).first(telemetry.model_count));
    }
    return json;
}

Json pairs_json(const Telemetry& telemetry)
{
    Json pairs = Json::array();
    for (std::size_t i = 0; i < telemetry.pair_count; ++i)
    {
        const PairTelemetry& pair = telemetry.pairs[i];
        pairs.push_back({{"tool", pair.tool},
                         {"server", fmt::format("{:016x}", pair.server_epoch)},
                         {"object", pair.object},
                         {"kind", kAnswerNames[static_cast<std::size_t>(pair.kind)]},
                         {"lower_m", number_of(pair.lower_m)},
                         {"upper_m", number_of(pair.upper_m)},
                         {"point_m", pair.point_m},
                         {"force_n", pair.force_n}});
    }
    return pairs;
}

Json models_json(const dds::WatchedController& told)
{
    Json models = Json::array();
    const auto pool = [](const PoolTelemetry& use) { return Json{use.used, use.capacity}; };
    for (std::size_t i = 0; i < told.models.size(); ++i)
    {
        const ModelTelemetry& model = told.telemetry.models[i];
        models.push_back({{"name", told.models[i].name},
                          {"hash", hash_text(told.models[i].hash)},
                          {"pages", pool(model.pages)},
                          {"faces", pool(model.faces)},
                          {"server_gone", model.server_gone},
                          {"is_static", model.is_static},
                          {"pieces", model.pieces},
                          {"piece_wait_ms", static_cast<double>(model.piece_wait_ns) * 1e-6}});
    }
    return models;
}

/// Models of the refinement state, then other models of objects.
std::vector<ContentHash> models_of(const LiveController& controller, const RefinementState& state)
{
    std::vector<ContentHash> models;
    std::ranges::transform(state.models, std::back_inserter(models), &RefinementStateModel::hash);
    for (const ObjectTelemetry& object : controller.objects)
    {
        if (std::ranges::find(models, object.model) == models.end())
        {
            models.push_back(object.model);
        }
    }
    return models;
}

Json cuts_json(const LiveController& controller, const RefinementState& state,
               const ModelShelf& shelf)
{
    Json cuts = Json::array();
    for (const ContentHash& hash : models_of(controller, state))
    {
        const RefinementStateModel model = model_in(state, hash);
        int refined = 0;
        for (const RefinementStatePage& page : model.pages)
        {
            refined += std::popcount(page.refined);
        }
        const auto known = shelf.find(hash);
        const std::uint32_t edits = known != nullptr ? known->edit_revision() : 0;
        cuts.push_back({{"hash", hash_text(hash)},
                        {"is_resident", known != nullptr},
                        {"cut", fmt::format("{:016x}{}", cut_id(model.pages),
                                            edits > 0 ? fmt::format("-{}", edits) : "")},
                        {"edits", edits},
                        {"pages", model.pages.size()},
                        {"refined", refined},
                        {"requested", model.requested.size()}});
    }
    return cuts;
}

Json regions_json(const RefinementState& state)
{
    Json regions = Json::array();
    for (const RefinementStateRegion& region : state.regions)
    {
        regions.push_back({{"model", hash_text(state.models[region.model].hash)},
                           {"is_predicted", region.is_predicted},
                           {"center_m", region.center_m},
                           {"radius_m", region.radius_m}});
    }
    return regions;
}

/// Fields of the feed, with the poses of the models' frames, in which the page draws faces.
Json objects_json(const LiveController& controller, const ModelShelf& shelf)
{
    Json objects = Json::array();
    for (ObjectTelemetry object : controller.objects)
    {
        if (const auto known = shelf.find(object.model))
        {
            object.pose = frame_pose_of(object.pose, known->header().origin_m());
        }
        objects.push_back(feed_object(object));
    }
    return objects;
}

Json refinement_state_json(const LiveController& controller, const ModelShelf& shelf)
{
    if (controller.told.state == nullptr)
    {
        return nullptr;
    }
    const RefinementState& state = controller.told.state->state;
    Json times = nullptr;
    for (std::size_t i = 0; i < kFrontTimes && !controller.is_recorded; ++i)
    {
        times[time_name(i)] = {state.times[i].mean_ns * 1e-3, state.times[i].max_ns * 1e-3};
    }
    return {{"serial", controller.told.state->serial},
            {"frame", state.frame},
            {"times_us", times},
            {"budgets",
             {{"splits", state.budgets.splits},
              {"merges", state.budgets.merges},
              {"nodes", state.budgets.nodes},
              {"triangles", state.budgets.triangles},
              {"pages", state.budgets.pages},
              {"requests", state.budgets.requests}}},
            {"slots_left_out", state.slots_left_out},
            {"regions_left_out", state.regions_left_out},
            {"models", cuts_json(controller, state, shelf)},
            {"regions", regions_json(state)},
            {"objects", objects_json(controller, shelf)}};
}

Json deadlines_json(const Telemetry& telemetry)
{
    return {{"missed", telemetry.missed},
            {"overruns", telemetry.overruns},
            {"latency_misses", telemetry.latency_misses}};
}

Json controller_json(const LiveController& controller, const ModelShelf& shelf)
{
    const Telemetry& telemetry = controller.told.telemetry;
    Json tools = Json::array();
    for (std::size_t i = 0; i < telemetry.tool_count; ++i)
    {
        tools.push_back(tool_json(controller, i));
    }
    return {{"id", id_text(controller.told.id)},
            {"name", controller.told.name},
            {"serial", controller.told.serial},
            {"frame", telemetry.frame},
            {"time_s", static_cast<double>(telemetry.time_ns) * 1e-9},
            {"period_us", static_cast<double>(telemetry.period_ns) * 1e-3},
            {"answers",
             {{"exact", telemetry.exact},
              {"separated", telemetry.separated},
              {"bounded", telemetry.bounded},
              {"stale", telemetry.stale},
              {"within_tolerance", telemetry.within_tolerance}}},
            {"deadlines", controller.is_recorded ? Json(nullptr) : deadlines_json(telemetry)},
            {"faults", faults_of(telemetry.faults_now)},
            {"faults_seen", faults_of(telemetry.faults_seen)},
            {"tools", tools},
            {"pairs", pairs_json(telemetry)},
            {"models", models_json(controller.told)},
            {"front", refinement_state_json(controller, shelf)}};
}

/// Reason why the page shows no surface; empty if it shows one.
std::string waits_for(const LiveController* controller, const ModelShelf& shelf,
                      const std::string& chosen, std::uint32_t domain_id)
{
    if (controller == nullptr)
    {
        return chosen.empty()
                   ? fmt::format(
                         "a controller on DDS domain {0}: start 'hrtc --model NAME --domain {0}' "
                         "or 'hrtc FILE --domain {0}' (with FILE, viewers need --domain)",
                         domain_id)
                   : "the chosen controller, which disconnected";
    }
    const RefinementState* state = controller->state();
    if (state == nullptr)
    {
        return fmt::format("the refinement state of {}: the controller runs with "
                           "--no-refinement-state or is older than this viewer",
                           controller->told.name);
    }
    for (const ContentHash& model : models_of(*controller, *state))
    {
        if (!shelf.has(model))
        {
            return shelf.is_coming(model)
                       ? fmt::format("the base mesh of model {}, from its server", hash_text(model))
                       : fmt::format("the model {}: no server publishes it on this domain; give "
                                     "its file to spm_view",
                                     hash_text(model));
        }
    }
    return "";
}

Json films_json(const Films& films)
{
    Json each = Json::array();
    for (const auto& film : films.films())
    {
        each.push_back(
            {{"name", film->name()}, {"frames", film->frames()}, {"note", film->note()}});
    }
    Json differences = Json::array();
    for (const FilmDifference& difference : films.differences())
    {
        differences.push_back(
            {{"what", difference.what}, {"how", difference.how}, {"frame", difference.frame}});
    }
    return {{"frames", films.frames()},
            {"period_s", static_cast<double>(films.films().front()->period_ns()) * 1e-9},
            {"films", each},
            {"differences", differences}};
}

} // namespace

std::string state_json(const Snapshot& snapshot, const ModelShelf& shelf, const std::string& chosen,
                       std::uint32_t domain_id, const Films* films)
{
    const LiveController* controller = snapshot.find(chosen);
    Json controllers = Json::array();
    for (const LiveController& each : snapshot.controllers)
    {
        controllers.push_back({{"id", id_text(each.told.id)}, {"name", each.told.name}});
    }
    Json models = Json::array();
    for (const ModelShelf::Label& label : shelf.labels())
    {
        models.push_back(
            {{"hash", hash_text(label.hash)}, {"name", label.name}, {"faces", label.faces}});
    }
    const Json state{{"serial", snapshot.serial},
                     {"domain", domain_id},
                     {"waits_for", waits_for(controller, shelf, chosen, domain_id)},
                     {"controllers", controllers},
                     {"models", models},
                     {"film", films == nullptr ? Json(nullptr) : films_json(*films)},
                     {"controller",
                      controller == nullptr ? Json(nullptr) : controller_json(*controller, shelf)}};
    // Names of files may not be UTF-8; invalid bytes are replaced.
    return state.dump(-1, ' ', true, Json::error_handler_t::replace);
}

std::string metrics_text(const Snapshot& snapshot)
{
    std::vector<const dds::WatchedController*> controllers;
    for (const LiveController& controller : snapshot.controllers)
    {
        controllers.push_back(&controller.told);
    }
    web::PrometheusText text;
    web::tell_controllers(text, controllers);
    return text.text();
}

} // namespace tactus::view
