// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/report/report.hpp"

#include "platform/controller/finished_run.hpp"
#include "platform/devices/udp/udp_device.hpp"
#include "platform/loop/machine.hpp"
#include "platform/machine/allocation_counter.hpp"
#include "rt_core/force/stiffness_rule.hpp"
#include "rt_core/forest/vertex_forest.hpp"
#include "rt_core/scene/object_table.hpp"
#include "transport/base/atomic_file.hpp"
#include "transport/chunk_loader.hpp"
#include "transport/content_hash.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <sstream>

namespace tactus::hrtc
{

namespace
{

using Json = nlohmann::ordered_json;

/// Data from which a report is made.
struct RunRecord
{
    const Options& options;
    const Controller& controller;
    const FinishedRun& run;
};

Json times_of(const LatencyHistogram& histogram)
{
    return {{"mean", histogram.mean_ns() * 1e-3},       {"p50", to_us(histogram.quantile(0.5))},
            {"p90", to_us(histogram.quantile(0.9))},    {"p99", to_us(histogram.quantile(0.99))},
            {"p999", to_us(histogram.quantile(0.999))}, {"max", to_us(histogram.max())}};
}

Json answers_of(const AnswerCounts& answers, double diagonal_m)
{
    return {{"exact", answers.exact},
            {"separated", answers.separated},
            {"within_tolerance", answers.within_tolerance},
            {"bounded", answers.bounded},
            {"stale", answers.stale},
            {"tolerated_max_m", answers.tolerated_max_m},
            {"longest_inexact_run", answers.longest_inexact_run},
            {"width_max_diag", answers.width_max_m / diagonal_m}};
}

Json pool_of(const PoolUse& use, std::size_t bytes_each)
{
    return {{"used_max", use.used_max},
            {"capacity", use.capacity},
            {"bytes", use.capacity * bytes_each}};
}

/// Sum of the models' use of a pool. `for_streamed_models` is capacity that belongs to no model.
/// Peaks of models that share a pool may come at different times, so their sum is clamped to the
/// capacity.
PoolUse sum_of(const std::vector<ModelOutput>& models, PoolUse ModelOutput::*pool,
               std::uint32_t for_streamed_models)
{
    PoolUse sum;
    sum.capacity = for_streamed_models;
    for (const ModelOutput& model : models)
    {
        sum.used_max += (model.*pool).used_max;
        sum.capacity += (model.*pool).capacity;
    }
    sum.used_max = std::min(sum.used_max, sum.capacity);
    return sum;
}

/// Pools, summed over the models. `bytes` is the memory of one pool. `total_bytes` is all memory of
/// frame and chunk loader: pools, tables (page table, links, requests) and queues.
Json pools_of(const RunRecord& record)
{
    constexpr std::size_t kFaceBytes =
        sizeof(VertexForest::ActiveFace) + 2 * sizeof(IdTable::Entry);
    const std::vector<ModelOutput>& models = record.run.statistics.models;
    const ModelCapacities& streamed_models = record.controller.setup().for_streamed_models;
    return {
        {"pages",
         pool_of(sum_of(models, &ModelOutput::pages, streamed_models.pages), sizeof(Page))},
        {"index_pages",
         pool_of(sum_of(models, &ModelOutput::index_pages, streamed_models.index_pages),
                 sizeof(IndexPage))},
        {"faces", pool_of(sum_of(models, &ModelOutput::faces, streamed_models.faces), kFaceBytes)},
        {"blocks", pool_of(sum_of(models, &ModelOutput::blocks, streamed_models.blocks),
                           sizeof(BlockGeometry) + sizeof(BlockSide))},
        {"nodes",
         pool_of(sum_of(models, &ModelOutput::nodes, streamed_models.nodes), sizeof(AbNode))},
        {"total_bytes", record.controller.pool_bytes()}};
}

/// Motion of the object. All counts are zero with models from files, and if poses aren't followed.
Json pose_of(const FinishedRun& run, std::size_t model, std::size_t object)
{
    const PoseUse use = run.pose_uses.empty() ? PoseUse{} : run.pose_uses[object];
    const dds::PoseCounts counts =
        run.pose_counts.empty() ? dds::PoseCounts{} : run.pose_counts[model];
    Json refused = Json::object();
    for (std::size_t i = 0; i < kPoseRefusals; ++i)
    {
        refused[kPoseRefusalNames[i]] = counts.refused[i];
    }
    return {{"followed", use.is_followed},  {"accepted", counts.accepted},
            {"refused", refused},           {"moves", use.moves},
            {"step_max_m", use.step_max_m}, {"age_max_s", to_seconds(use.age_max)},
            {"old_frames", use.old_frames}, {"rate_limited_frames", use.rate_limited_frames}};
}

Json models_of(const RunRecord& record)
{
    Json list = Json::array();
    const std::vector<std::uint32_t> first = record.controller.first_objects();
    for (std::size_t i = 0; i < record.controller.models().size(); ++i)
    {
        const ServedModel& served = record.controller.models()[i];
        const ModelHeader header = ModelHeader::parse(served.header).value();
        const ModelOutput& output = record.run.statistics.models[i];
        const ChunkLoaderCounters& chunk_loader =
            record.controller.chunk_loader().counters(static_cast<std::uint32_t>(i));
        list.push_back({{"name", served.name},
                        {"hash", hash_text(served.hash)},
                        {"faces", header.fields().source_faces},
                        {"diagonal_m", header.diagonal_m()},
                        {"edits", output.edit_revision},
                        {"edits_refused",
                         record.run.edit_counts.empty() ? 0U : record.run.edit_counts[i].refused},
                        {"added_faces", output.added.used},
                        {"pages_used_max", output.pages.used_max},
                        {"faces_used_max", output.faces.used_max},
                        {"refined_records", output.refined_records},
                        {"static", output.is_static},
                        {"stage", kModelStageNames[static_cast<std::size_t>(output.stage)]},
                        {"bytes_received", served.link->bytes_received()},
                        {"pieces_refused", chunk_loader.refused() + served.link->damaged()},
                        {"pieces_overdue", chunk_loader.overdue},
                        {"pieces_missing", chunk_loader.overdue - chunk_loader.overdue_came},
                        {"server_connected", served.link->state() == LinkState::connected},
                        {"pose", first[i] < record.controller.objects().size()
                                     ? pose_of(record.run, i, first[i])
                                     : Json()}});
    }
    return list;
}

double stiffness_limit_of(const ConditionerSetup& setup)
{
    return stiffness_limit(setup.device, setup.period_s);
}

/// Number of frames with each ForceAction. The start-up ramp is none of these; ForceFader makes it.
Json conditioned_of(const ForceCounts& force)
{
    Json json = Json::object();
    for (std::size_t bit = 0; bit < kForceActions; ++bit)
    {
        json[kForceActionNames[bit]] = force.conditioned[bit];
    }
    return json;
}

/// Datagrams between a UDP device and its driver; null for other devices.
Json traffic_of(const HapticDevice& device)
{
    const auto* udp = dynamic_cast<const UdpDevice*>(&device);
    if (udp == nullptr)
    {
        return {};
    }
    const UdpTraffic traffic = udp->traffic();
    Json refused = Json::object();
    for (std::size_t i = 0; i < udp::kDatagramFaults; ++i)
    {
        refused[udp::kDatagramFaultNames[i]] = traffic.refused[i];
    }
    return {{"described", traffic.described},
            {"samples", traffic.samples},
            {"sessions", traffic.sessions},
            {"lost", traffic.lost},
            {"forces", traffic.forces},
            {"unsent", traffic.unsent},
            {"refused", refused}};
}

/// Name of the model that the tool begins inside; null if it begins outside.
Json begins_inside(const FinishedRun& run, std::size_t tool)
{
    const bool is_inside = tool < run.begins_inside.size() && !run.begins_inside[tool].empty();
    return is_inside ? Json(run.begins_inside[tool]) : Json();
}

Json tools_of(const RunRecord& record)
{
    Json list = Json::array();
    const double frames =
        static_cast<double>(std::max<std::uint64_t>(record.run.statistics.frames, 1));
    for (std::size_t i = 0; i < record.controller.tools().size(); ++i)
    {
        const ForceCounts& force = record.run.statistics.tools[i];
        const std::string& fixture = record.controller.tools()[i].fixture;
        list.push_back({{"shape", record.controller.tools()[i].shape},
                        {"radius_m", record.controller.tools()[i].spec.radius_m},
                        {"begins_inside", begins_inside(record.run, i)},
                        {"shading_m", record.controller.tools()[i].spec.shading_m},
                        {"force_max_n", force.max_n},
                        {"force_max_step_n", force.max_step_n},
                        {"torque_max_nm", force.torque_max_nm},
                        {"torque_max_step_nm", force.torque_max_step_nm},
                        {"twist_max_rad", force.twist_max_rad},
                        {"fixture", fixture.empty() ? Json() : Json(fixture)},
                        {"fixture_max_n", force.fixture_max_n},
                        {"mass_kg", record.controller.tools()[i].load.mass_kg},
                        {"load_max_n", force.load_max_n},
                        {"load_max_nm", force.load_max_nm},
                        {"contact_share", static_cast<double>(force.contact_frames) / frames},
                        {"force_share", static_cast<double>(force.force_frames) / frames},
                        {"halted_frames", force.halted_frames},
                        {"data_limited_frames", force.data_limited_frames},
                        {"lag_max_m", force.lag_max_m},
                        {"stiffness_limit_n_per_m",
                         stiffness_limit_of(record.controller.tools()[i].conditioner)},
                        {"least_stiffness_n_per_m", std::isfinite(force.least_stiffness_n_per_m)
                                                        ? Json(force.least_stiffness_n_per_m)
                                                        : Json()},
                        {"observed_energy_max_j", force.observed_energy_max_j},
                        {"conditioned", conditioned_of(force)},
                        {"traffic", traffic_of(*record.controller.tools()[i].device)}});
    }
    return list;
}

Json pairs_of(const RunRecord& record)
{
    Json list = Json::array();
    const ObjectTable& objects = record.controller.object_table();
    const std::uint32_t places = objects.capacity();
    for (std::size_t i = 0; i < record.run.statistics.pairs.size(); ++i)
    {
        const auto object = static_cast<std::uint32_t>(i % places);
        const AnswerCounts& answers = record.run.statistics.pairs[i];
        if (answers.in_all() == 0)
        {
            continue; // The tool and the object were never near each other.
        }
        list.push_back(
            {{"tool", i / places},
             {"object", object},
             {"model", record.controller.models()[objects[object].spec.model.value].name},
             {"answers", answers_of(answers, record.controller.diagonal_world_m())}});
    }
    return list;
}

Json scene_of(const RunRecord& record)
{
    const RunStatistics& statistics = record.run.statistics;
    const SceneCapacities room = capacities_of(record.controller.setup());
    Json refused = Json::object();
    for (std::size_t i = 0; i < kChangeRefusals; ++i)
    {
        refused[kChangeRefusalNames[i]] = statistics.changes_refused[i];
    }
    Json models = Json::object();
    for (std::size_t i = 0; i < kModelStages; ++i)
    {
        const auto is_there = [i](const ModelOutput& model)
        { return static_cast<std::size_t>(model.stage) == i; };
        models[kModelStageNames[i]] = std::ranges::count_if(statistics.models, is_there);
    }
    return {{"objects", statistics.objects_now},
            {"objects_max", statistics.objects_max},
            {"objects_room", room.objects},
            {"pairs_awake_max", statistics.pairs_awake_max},
            {"pairs_room", room.pairs},
            {"invisible_wall_frames", statistics.invisible_wall_frames},
            {"capacity_exceeded_frames", statistics.capacity_exceeded_frames},
            {"shed_pairs", statistics.shed_pairs},
            {"added", record.run.scene_news.came},
            {"removed", record.run.scene_news.went},
            {"material_changes", record.run.scene_news.feels},
            {"limited", record.run.scene_news.limited},
            {"ignored", record.run.scene_news.passed_over},
            {"motion_regained", record.run.scene_news.motion_regained},
            {"traversals", statistics.scene_walks},
            {"models", models},
            {"changes_refused", refused}};
}

Json carving_of(const std::optional<CutCounts>& cuts)
{
    return !cuts ? Json(nullptr)
                 : Json{{"sent", cuts->sent},
                        {"unsent", cuts->unsent},
                        {"samples_lost", cuts->samples_lost},
                        {"volume_mm3", cuts->volume_m3 * 1e9}};
}

Json force_of(const RunStatistics& statistics)
{
    ForceCounts worst;
    for (const ForceCounts& tool : statistics.tools)
    {
        worst.max_n = std::max(worst.max_n, tool.max_n);
        worst.max_step_n = std::max(worst.max_step_n, tool.max_step_n);
    }
    const double frames = static_cast<double>(std::max<std::uint64_t>(statistics.frames, 1));
    return {{"max_n", worst.max_n},
            {"max_step_n", worst.max_step_n},
            {"contact_share", static_cast<double>(statistics.contact_frames) / frames},
            {"force_share", static_cast<double>(statistics.force_frames) / frames},
            {"data_limited_share", static_cast<double>(statistics.data_limited_frames) / frames}};
}

Json machine_of(const RunRecord& record)
{
    const Machine machine = describe_machine();
    return {{"kernel", machine.kernel},
            {"preemption", machine.preemption},
            {"processor", machine.processor},
            {"processors", machine.processors},
            {"load_average", machine.load_average},
            {"date_utc", machine.date_utc},
            {"fifo", record.run.thread.fifo},
            {"memory_locked", record.run.thread.memory_locked},
            {"processors_awake", record.run.thread.processors_awake},
            {"float_control_was_default", record.run.thread.float_control_was_default},
            {"refused", record.run.thread.refused}};
}

Json budgets_of(const RunRecord& record)
{
    const RunStatistics& run = record.run.statistics;
    const auto range_of = [&run](const WorkRange& range)
    {
        return Json{{"min", range.min},
                    {"mean", static_cast<double>(range.sum) /
                                 static_cast<double>(std::max<std::uint64_t>(run.frames, 1))},
                    {"max", range.max}};
    };
    return {{"frame_us", to_us(record.options.frame_budget())},
            {"splits", record.options.splits},
            {"work", range_of(run.work_allowed)},
            {"work_done", range_of(run.work_done)},
            {"at_floor", run.work_at_floor}};
}

Json work_of(const RunStatistics& statistics)
{
    Json skipped = Json::object();
    for (std::size_t i = 0; i < kSkips; ++i)
    {
        skipped[kSkipNames[i]] = statistics.skipped[i];
    }
    return {{"splits", statistics.splits},
            {"merges", statistics.merges},
            {"nodes_visited", statistics.nodes_visited},
            {"pages_adopted", statistics.pages_adopted},
            {"skipped", skipped}};
}

Json faults_of(const RunStatistics& statistics)
{
    Json faults = Json::object();
    for (std::size_t bit = 0; bit < kFrameFaultNames.size(); ++bit)
    {
        faults[kFrameFaultNames[bit]] = statistics.faults[bit];
    }
    return faults;
}

Json cache_of(const RunRecord& record)
{
    std::uint64_t loads = 0;
    const ChunkLoader& chunk_loader = record.controller.chunk_loader();
    for (std::uint32_t i = 0; i < chunk_loader.model_count(); ++i)
    {
        loads += chunk_loader.counters(i).delivered;
    }
    const RunStatistics& statistics = record.run.statistics;
    return {{"prediction", prediction_name(record.controller.setup().prediction)},
            {"hits", statistics.cache_hits},
            {"misses", statistics.cache_misses},
            {"loads", loads},
            {"evictions", statistics.evictions}};
}

Json wire_of(const RunRecord& record)
{
    std::uint64_t bytes_received = 0;
    WaitingTimes waiting;
    for (std::size_t i = 0; i < record.controller.models().size(); ++i)
    {
        bytes_received += record.controller.models()[i].link->bytes_received();
        waiting += record.controller.chunk_loader().waiting_times(static_cast<std::uint32_t>(i));
    }
    const auto ms = [&](double value) { return waiting.total() > 0 ? Json(value) : Json(); };
    return {{"bytes_received", bytes_received},
            {"server_lost", record.run.server_was_lost},
            {"arrival_ms",
             {{"p50", ms(waiting.quantile_ms(0.5))},
              {"p99", ms(waiting.quantile_ms(0.99))},
              {"max", ms(waiting.longest_ms())}}}};
}

/// Refused messages of other participants of the domain, one entry for each.
Json refused_of(const std::vector<dds::PeerRefusals>& peers)
{
    Json list = Json::array();
    for (const dds::PeerRefusals& peer : peers)
    {
        Json entry{{"peer", peer.name}, {"id", hash_text(peer.id)}};
        for (std::size_t i = 0; i < dds::kRefusedKinds; ++i)
        {
            entry[dds::refused_names().at(i)] = peer.counts.at(i);
        }
        list.push_back(std::move(entry));
    }
    return list;
}

/// Options that were given or have a value, one a line, without comments.
std::string settings_of(const std::string& option_file)
{
    std::istringstream lines(option_file);
    std::string text;
    for (std::string line; std::getline(lines, line);)
    {
        const bool says_something = !line.empty() && !line.starts_with('#');
        text += says_something ? (text.empty() ? "" : "\n") + line : "";
    }
    return text;
}

/// Time in the form of ISO 8601, to the second.
std::string utc_text(std::time_t time)
{
    std::tm parts{};
    ::gmtime_r(&time, &parts);
    return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", parts.tm_year + 1900,
                       parts.tm_mon + 1, parts.tm_mday, parts.tm_hour, parts.tm_min, parts.tm_sec);
}

/// Data with which the run can be repeated.
Json run_of(const RunRecord& record)
{
    Json devices = Json::array();
    for (const ToolSetup& tool : record.controller.tools())
    {
        devices.push_back(tool.device->info().name);
    }
    return {{"version", TACTUS_VERSION},
            {"started_utc", utc_text(record.run.started)},
            {"devices", devices},
            {"kernels", record.controller.setup().kernels->name},
            {"options", settings_of(record.options.as_file)}};
}

Json recording_of(const std::optional<RecordingResult>& recording)
{
    if (!recording)
    {
        return nullptr;
    }
    Json json{{"frames", recording->frames}, {"bytes", recording->bytes}, {"lost_from", nullptr}};
    if (recording->lost_from != kNoFrame)
    {
        json["lost_from"] = recording->lost_from;
    }
    return json;
}

Json trace_of(const std::optional<TraceResult>& trace)
{
    return !trace ? Json(nullptr)
                  : Json{{"frames", trace->frames},
                         {"rounds", trace->rounds},
                         {"bytes", trace->bytes},
                         {"lost", trace->lost}};
}

} // namespace

Json make_report(const Options& options, const Controller& controller, const FinishedRun& run)
{
    const RunRecord record{options, controller, run};
    const RunStatistics& statistics = run.statistics;
    Json times = Json::object();
    for (const auto& [name, histogram] : statistics.times())
    {
        times[name] = times_of(histogram);
    }
    return {{"schema", 3},
            {"run", run_of(record)},
            {"frames", statistics.frames},
            {"period_ns", run.period.ns},
            {"duration_s",
             static_cast<double>(statistics.frames) * static_cast<double>(run.period.ns) * 1e-9},
            {"times_us", times},
            {"answers", answers_of(statistics.answers, record.controller.diagonal_world_m())},
            {"work", work_of(statistics)},
            {"budgets", budgets_of(record)},
            {"scene", scene_of(record)},
            {"pools", pools_of(record)},
            {"cache", cache_of(record)},
            {"wire", wire_of(record)},
            {"servers", servers_of(run)},
            {"refused", refused_of(run.refused)},
            {"deadline", deadlines_of(run)},
            {"realtime",
             {{"allocations", statistics.deadlines.allocations},
              {"allocations_counted", allocation_counter::available()},
              {"page_faults", statistics.deadlines.page_faults},
              {"virtual_time", record.options.virtual_time},
              {"system_calls_trapped", record.options.trap_system_calls},
              {"system_calls_in_frame", statistics.deadlines.calls.in_frame},
              {"system_calls_outside", statistics.deadlines.calls.outside}}},
            {"recording", recording_of(record.run.recording)},
            {"trace", trace_of(record.run.trace)},
            {"carving", carving_of(record.run.cuts)},
            {"telemetry",
             {{"sent", record.run.telemetry_sent}, {"states_sent", record.run.states_sent}}},
            {"force", force_of(statistics)},
            {"safety", safety_of(run)},
            {"faults", faults_of(statistics)},
            {"machine", machine_of(record)},
            {"models", models_of(record)},
            {"tools", tools_of(record)},
            {"pairs", pairs_of(record)}};
}

std::optional<Refusal> write_report(const Json& report, const std::string& path)
{
    return write_text(report.dump(2) + '\n', path);
}

} // namespace tactus::hrtc
