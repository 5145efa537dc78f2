// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/placed_models.hpp"
#include "host_tools/spm_publish/edited_models.hpp"
#include "host_tools/spm_publish/namesakes.hpp"
#include "host_tools/spm_publish/options.hpp"
#include "host_tools/spm_publish/pose_script.hpp"
#include "host_tools/spm_publish/server_metrics.hpp"
#include "host_tools/spm_publish/serving_report.hpp"
#include "platform/program/command_line.hpp"
#include "platform/program/run_program.hpp"
#include "transport/base/number_form.hpp"
#include "transport/base/refusal.hpp"
#include "transport/content_hash.hpp"
#include "transport/dds/dds_server.hpp"
#include "transport/dds/key_folder.hpp"
#include "transport/dds/telemetry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace tactus::spm_publish
{

namespace
{

/// An object that the server may show.
struct Prop
{
    ShownObject shown; ///< Object; the hash of its model is set when the models are open.
    std::size_t model{0};
    bool is_there_from_start{false};
    std::optional<std::uint32_t> number{}; ///< Number while shown; none otherwise.
};

/// Optional parts of the server.
struct Extras
{
    std::vector<Prop> props;
    std::optional<PosePlayer> player;
    std::unique_ptr<dds::TelemetryReader> controllers; ///< Null without --watch and --metrics.
    std::optional<Watch> watch;
    std::optional<ServerMetrics> metrics;
    std::optional<EditedModels> edited; ///< None without --edits.
    Namesakes* namesakes{nullptr};      ///< Null if other servers cannot be found.
};

/// Replaces the scene in options.files by its models, and returns the scene's objects.
Result<std::vector<Prop>, Refusal> open_scene(Options& options)
{
    const auto scene = read_placed_models(options.files.front());
    if (!scene)
    {
        return scene.error();
    }
    for (const std::string& note : scene.value().notes)
    {
        log_message(LogLevel::info, "spm_publish", "note: " + note);
    }
    std::vector<Prop> props;
    for (const PlacedModel& object : scene.value().objects)
    {
        props.push_back({{object.name, {}, object.material, object.pose}, object.model, true});
    }
    options.files.clear();
    for (const std::filesystem::path& file : scene.value().files)
    {
        options.files.push_back(file.string());
    }
    return props;
}

/// Objects if no scene is given: one for each model, with its name.
std::vector<Prop> props_of(const std::vector<std::string>& names)
{
    std::vector<Prop> props;
    for (std::size_t i = 0; i < names.size(); ++i)
    {
        props.push_back({{names[i], {}, {}, {}}, i});
    }
    return props;
}

/// Reads all chunks and returns the first fault. ModelStore::open() has checked the rest.
std::optional<Refusal> find_damage(const ModelStore& store)
{
    std::vector<std::byte> coded;
    for (std::uint32_t chunk = 0; chunk < store.header().counts().chunks(); ++chunk)
    {
        if (const auto read = store.read({ContentKind::chunk, chunk}, coded); !read)
        {
            return read.error();
        }
    }
    return std::nullopt;
}

Result<std::vector<dds::PublishedModel>, Refusal> open_models(const Options& options)
{
    std::vector<dds::PublishedModel> models;
    for (std::size_t i = 0; i < options.names.size(); ++i)
    {
        auto store = ModelStore::open(options.files[i]);
        if (!store)
        {
            return store.error();
        }
        if (const auto damage = find_damage(store.value()))
        {
            return *damage;
        }
        models.push_back({options.names[i], std::move(store).value(), options.edit_room});
    }
    return models;
}

void print_models(ServingReport& report, dds::DdsServer& server, const std::string& scene,
                  std::uint32_t domain)
{
    for (const dds::ModelPieces& model : server.models())
    {
        const HeaderFields& fields = model.store().header().fields();
        report.print_line(fmt::format("serving '{}' hash {}: {} faces, {} bytes, from {}",
                                      model.model().name, hash_text(model.store().hash()),
                                      fields.source_faces, fields.file_bytes,
                                      model.store().path().string()));
    }
    if (const std::size_t objects = server.objects().objects(); objects > 0)
    {
        report.print_line(fmt::format("showing {}{}", counted(objects, "object"),
                                      scene.empty() ? "" : fmt::format(" as scene '{}'", scene)));
    }
    report.print_line(fmt::format("ready on DDS domain {}; end with Ctrl-C", domain));
}

/// Controllers that may edit. Without names, all that reach the topic: those of this machine, or
/// with keys those with the right; on a network without keys, none.
dds::Editors editors_of(const Options& options)
{
    dds::Editors editors;
    editors.names = options.editors;
    const char* uri = std::getenv("CYCLONEDDS_URI");
    const bool is_closed = uri == nullptr || !dds::is_open_to_network(uri);
    editors.all = std::ranges::count(options.editors, "any") > 0 ||
                  (options.editors.empty() && (!options.security.keys.empty() || is_closed));
    return editors;
}

/// Lines of the pose file; empty without a pose file.
Result<std::vector<PoseLine>, Refusal> read_poses(const Options& options,
                                                  const std::vector<ScriptedObject>& objects)
{
    if (options.poses_path.empty())
    {
        return std::vector<PoseLine>{};
    }
    auto lines = read_pose_file(options.poses_path, objects);
    if (lines && options.poses_loop && lines.value().back().time_s == 0.0)
    {
        return Refusal{options.poses_path + ": --poses-loop needs a last line with a time "
                                            "above 0 s"};
    }
    return lines && options.poses_rate_hz
               ? interpolated(lines.value(), objects.size(), *options.poses_rate_hz)
               : std::move(lines);
}

Result<Extras, Refusal> make_extras(const Options& options, dds::DdsServer& server,
                                    std::vector<Prop> props, std::vector<PoseLine> lines)
{
    Extras extras;
    for (Prop& prop : props)
    {
        prop.shown.model = server.models()[prop.model].store().hash();
        if (!prop.is_there_from_start)
        {
            continue;
        }
        const auto number = server.objects().show(prop.shown);
        if (!number)
        {
            return number.error();
        }
        prop.number = number.value();
    }
    if (!lines.empty())
    {
        extras.player.emplace(std::move(lines), props.size(), options.poses_loop);
    }
    extras.props = std::move(props);
    if (options.watch || options.metrics_port)
    {
        auto reader = dds::TelemetryReader::create(server.domain());
        if (!reader)
        {
            return reader.error();
        }
        extras.controllers = std::move(reader).value();
    }
    if (options.watch)
    {
        extras.watch.emplace();
    }
    return extras;
}

/// Starts the metrics page and prints its address, if --metrics is given.
std::optional<Refusal> start_metrics(const Options& options, dds::DdsServer& server, Extras& extras,
                                     ServingReport& report)
{
    if (!options.metrics_port)
    {
        return std::nullopt;
    }
    auto page =
        web::MetricsServer::start(static_cast<std::uint16_t>(*options.metrics_port), "--metrics");
    if (!page)
    {
        return page.error();
    }
    report.print_line(fmt::format("metrics on http://127.0.0.1:{}/metrics", page.value()->port()));
    extras.metrics.emplace(std::move(page).value());
    extras.metrics->update(server, *extras.controllers,
                           extras.edited ? &*extras.edited
                                         : nullptr); // The first request needs metrics.
    return std::nullopt;
}

/// Longest wait for requests: until the next pose, from 1 to 50 ms.
std::chrono::milliseconds longest_wait(const Extras& extras, double now_s)
{
    constexpr std::chrono::milliseconds least{1};
    if (!extras.player)
    {
        return std::chrono::milliseconds(50);
    }
    const std::chrono::milliseconds most{50};
    const double left_s = extras.player->next_s().value_or(now_s + 1.0) - now_s;
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        std::chrono::duration<double>(std::clamp(left_s, 0.0, 1.0)));
    return std::clamp(left, least, most);
}

void feel(Prop& prop, const Material& material, dds::ObjectPublisher& objects)
{
    prop.shown.material = material;
    if (prop.number)
    {
        const auto feels = objects.feel(*prop.number, material);
        TACTUS_ASSERT(feels.has_value()); // The file was checked.
    }
}

void stand(Prop& prop, const std::optional<Pose>& pose, dds::ObjectPublisher& objects)
{
    if (pose && prop.number)
    {
        const auto moved = objects.move(*prop.number, *pose);
        TACTUS_ASSERT(moved.has_value()); // The file was checked.
    }
    else if (pose)
    {
        prop.shown.pose = *pose;
        const auto number = objects.show(prop.shown);
        TACTUS_ASSERT(number.has_value()); // The number of props was checked.
        prop.number = number.value();
    }
    else if (prop.number)
    {
        objects.remove(*prop.number);
        prop.number.reset();
    }
}

/// Plays the lines of the pose file that are due.
void play(Extras& extras, dds::ObjectPublisher& objects, double now_s)
{
    for (const PoseLine& line : extras.player->take_due(now_s))
    {
        Prop& prop = extras.props[line.object];
        if (line.material)
        {
            feel(prop, *line.material, objects);
        }
        else
        {
            stand(prop, line.pose, objects);
        }
    }
}

void serve(dds::DdsServer& server, ServingReport& report, Extras& extras,
           const std::optional<double>& seconds)
{
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    const auto now_s = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
    while (!is_stop_requested() && !(seconds && now_s() >= *seconds))
    {
        server.wait(longest_wait(extras, now_s()));
        if (extras.player)
        {
            play(extras, server.objects(), now_s());
        }
        server.step();
        if (extras.edited)
        {
            extras.edited->step();
        }
        if (extras.controllers != nullptr)
        {
            extras.controllers->poll();
        }
        if (extras.watch)
        {
            extras.watch->update(*extras.controllers, server, report);
        }
        if (extras.metrics)
        {
            extras.metrics->update(server, *extras.controllers,
                                   extras.edited ? &*extras.edited : nullptr);
        }
        if (extras.namesakes != nullptr)
        {
            extras.namesakes->update();
        }
        report.update(server);
    }
}

/// Prints the edits of each model.
void print_edits(const EditedModels& edited, dds::DdsServer& server, ServingReport& report)
{
    for (std::size_t i = 0; i < server.models().size(); ++i)
    {
        const EditedModels::Counts& counts = edited.counts(i);
        report.print_line(fmt::format(
            "edits of '{}': {}, {}, {:.3f} mm^3 removed, {:.3f} mm^3 added, {} of {} added faces "
            "used, {} refused",
            server.models()[i].model().name, counted(counts.changes, "change"),
            counted(edited.revision(i), "edit"), counts.removed_m3 * 1e9, counts.gained_m3 * 1e9,
            edited.added_faces(i), server.models()[i].model().edit_room, counts.refused));
    }
    const dds::EditPublisher::Counters& sent = server.edits()->counters();
    report.print_line(fmt::format("{} accepted, {} refused, {:.1f} KB of edits sent",
                                  counted(sent.requests, "edit request"), sent.requests_refused,
                                  static_cast<double>(sent.bytes) / 1e3));
}

/// Saves the edited model if --save is given and there were edits.
std::optional<Refusal> save_edits(const Options& options, const EditedModels& edited,
                                  ServingReport& report)
{
    if (options.save_path.empty())
    {
        return std::nullopt;
    }
    if (edited.revision(0) == 0)
    {
        report.print_line(
            fmt::format("--save: {} is not written, since there were no edits", options.save_path));
        return std::nullopt;
    }
    std::vector<std::string> notes;
    const auto saved = edited.save(0, options.save_path, notes);
    if (!saved)
    {
        return Refusal{"--save: " + saved.error().text};
    }
    for (const std::string& note : notes)
    {
        report.print_line("note: " + note);
    }
    report.print_line(fmt::format("saved {}: {} faces, revision {}", options.save_path,
                                  saved.value().source_faces, saved.value().revision));
    return std::nullopt;
}

/// Prints what was sent, and prints and saves the edits.
std::optional<Refusal> end_serving(const Options& options, dds::DdsServer& server,
                                   const Extras& extras, ServingReport& report)
{
    const auto counters = server.counters();
    report.print_line(fmt::format("ended; {} chunks, {:.1f} KB sent", counters.pieces_sent,
                                  static_cast<double>(counters.bytes_sent) / 1e3));
    if (!extras.edited)
    {
        return std::nullopt;
    }
    print_edits(*extras.edited, server, report);
    return save_edits(options, *extras.edited, report);
}

/// Objects of the scene, or of the models without one; an exit code after a line on stderr. Sets
/// the names of a scene's models.
std::variant<std::vector<Prop>, int> find_props(const CommandLine& line, Options& options)
{
    if (!options.has_scene)
    {
        return props_of(options.names);
    }
    auto placed = open_scene(options);
    if (!placed)
    {
        return line.fail(placed.error().text);
    }
    auto names = choose_names(options.files, {});
    if (!names)
    {
        return line.fail(names.error().text, kExitUsage);
    }
    options.names = std::move(names).value();
    return std::move(placed).value();
}

int run(int argc, char** argv)
{
    CommandLine line("spm_publish", "Serves SPM models to controllers over DDS.");
    auto parsed = parse_options(line, argc, argv);
    if (const int* code = std::get_if<int>(&parsed))
    {
        return *code;
    }
    auto& options = std::get<Options>(parsed);
    auto found = find_props(line, options);
    if (const int* code = std::get_if<int>(&found))
    {
        return *code;
    }
    auto& props = std::get<std::vector<Prop>>(found);
    auto models = open_models(options);
    if (!models)
    {
        return line.fail(models.error().text);
    }
    std::vector<ScriptedObject> objects;
    for (const Prop& prop : props)
    {
        objects.push_back({prop.shown.name, prop.shown.pose.scale});
    }
    auto poses = read_poses(options, objects);
    if (!poses)
    {
        return line.fail(poses.error().text);
    }
    stop_on_signals();
    ServingReport report;
    const Log warn = [&report](const std::string& text)
    { report.print_line(text, LogLevel::warning); };
    auto server =
        dds::DdsServer::create({options.domain, options.security}, std::move(models).value(), warn,
                               options.scene, dds::Party::both, editors_of(options));
    if (!server)
    {
        return line.fail(server.error().text);
    }
    auto namesakes = Namesakes::create(*server.value(), options.scene, warn);
    if (!namesakes) // The permissions of a certificate may forbid it.
    {
        warn("other servers with these names can't be detected: " + namesakes.error().text);
    }
    auto extras = make_extras(options, *server.value(), std::move(props), std::move(poses).value());
    if (!extras)
    {
        return line.fail(extras.error().text);
    }
    if (options.has_edits)
    {
        auto edited = EditedModels::create(*server.value(), warn);
        if (!edited)
        {
            return line.fail(edited.error().text);
        }
        extras.value().edited = std::move(edited).value();
    }
    if (const auto refusal = start_metrics(options, *server.value(), extras.value(), report))
    {
        return line.fail(refusal->text);
    }
    print_models(report, *server.value(), options.scene, options.domain);
    extras.value().namesakes = namesakes ? &namesakes.value() : nullptr;
    serve(*server.value(), report, extras.value(), options.seconds);
    const auto refusal = end_serving(options, *server.value(), extras.value(), report);
    return refusal ? line.fail(refusal->text) : kExitDone;
}

} // namespace

} // namespace tactus::spm_publish

int main(int argc, char** argv)
{
    return tactus::run_program("spm_publish", "",
                               [&] { return tactus::spm_publish::run(argc, argv); });
}
