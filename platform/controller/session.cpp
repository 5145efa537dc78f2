// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/session.hpp"

#include "platform/choices/device_choice.hpp"
#include "platform/controller/controller.hpp"
#include "platform/controller/cut_sender.hpp"
#include "platform/controller/guardian.hpp"
#include "platform/controller/histogram_folder.hpp"
#include "platform/controller/server_topics.hpp"
#include "platform/controller/session_run.hpp"
#include "platform/devices/plugin/device_plugin.hpp"
#include "platform/loop/hand_tap.hpp"
#include "platform/machine/posix/linux_extras.hpp"
#include "platform/scene/program_scene.hpp"
#include "transport/base/atomic_file.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/store/store_link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <unistd.h>
#include <utility>

namespace tactus::hrtc
{

namespace
{

Result<std::vector<ServedModel>, Refusal> find_in_files(const Options& options)
{
    std::vector<ServedModel> models;
    for (std::size_t i = 0; i < options.models.size(); ++i)
    {
        const std::string& path = options.models[i];
        const std::string name = std::filesystem::path(path).stem().string();
        auto model = serve_from_file(path, is_valid_name(name) ? name : "model", log_line);
        if (!model)
        {
            return failure(model.error().text);
        }
        models.push_back(std::move(model).value());
        models.back().edit_room = i < options.edit_rooms.size() ? options.edit_rooms[i] : 0;
    }
    return models;
}

/// Finds the headers of published models; the controller fetches the base meshes that it needs. The
/// client must outlive the models' links.
Result<std::vector<ServedModel>, Refusal>
find_published(const Options& options, dds::DdsClient& client, const std::function<bool()>& goes_on)
{
    const auto wait = std::chrono::milliseconds(static_cast<std::int64_t>(options.wait_s * 1e3));
    std::vector<ModelSelector> selectors;
    for (const std::string& text : options.models)
    {
        selectors.push_back(parse_selector(text).value());
    }
    auto models = client.find_headers(selectors, wait, goes_on);
    if (!models)
    {
        return failure(models.error().text);
    }
    return models;
}

/// Setup of the recording, with the names of models and objects at the start.
RecordedSetup recorded_setup(const Options& options, const Controller& controller)
{
    RecordedSetup setup = to_recorded(controller.setup());
    for (std::uint32_t i = 0; i < controller.models().size(); ++i)
    {
        setup.names[{RecordedName::Kind::model, i}] = controller.models()[i].name;
    }
    for (std::uint32_t i = 0; i < options.objects.size(); ++i)
    {
        if (const std::string& name = options.objects[i].name; !name.empty())
        {
            setup.names[{RecordedName::Kind::object, i}] = name;
        }
    }
    return setup;
}

/// Starts the recorder if one is requested. Returns the reason if that fails.
std::optional<std::string> start_recorder(const Options& options, Controller& controller,
                                          std::optional<Recorder>& recorder)
{
    if (options.record_path.empty())
    {
        return std::nullopt;
    }
    auto file = AtomicFile::create(options.record_path);
    if (!file)
    {
        return "--record: " + file.error().text;
    }
    recorder.emplace(
        std::move(file).value(), recorded_setup(options, controller), controller.chunk_loader(),
        options.virtual_time ? Recorder::Worker::caller : Recorder::Worker::own_thread);
    return std::nullopt;
}

/// Starts the trace if one is requested. Returns the reason if that fails.
std::optional<std::string> start_trace(const Options& options, std::optional<TraceFile>& trace)
{
    if (options.trace_path.empty())
    {
        return std::nullopt;
    }
    auto file = AtomicFile::create(options.trace_path);
    if (!file)
    {
        return "--trace: " + file.error().text;
    }
    trace.emplace(std::move(file).value(), options.period());
    return std::nullopt;
}

/// Refusal if the processor of --cpu can't be used, or if real-time rights are missing without
/// --allow-no-rt; else none.
std::optional<Refusal> check_machine(const Options& options)
{
    const auto refused = probe_realtime(options.thread);
    if (!refused)
    {
        // Only the system can judge the value of --cpu, the one option that is checked here.
        const bool is_usage = refused.error().is_usage;
        return Refusal{(is_usage ? "--cpu: " : "") + refused.error().text, is_usage};
    }
    if (!refused.value().empty() && !options.thread.allow_no_rt)
    {
        for (const std::string& line : refused.value())
        {
            log_error(line);
        }
        return failure("not started; to run without these rights, use --allow-no-rt");
    }
    return std::nullopt;
}

/// Refusal of the first output that can't be written; none if all can.
std::optional<Refusal> check_outputs(const Options& options)
{
    for (const std::string& path : options.report_paths)
    {
        if (const auto error = probe_output(path))
        {
            return failure("--report: " + error->text);
        }
    }
    if (const auto error = probe_output(options.record_path))
    {
        return failure("--record: " + error->text);
    }
    if (const auto error = probe_output(options.trace_path))
    {
        return failure("--trace: " + error->text);
    }
    if (const auto error = options.histograms_folder.empty()
                               ? std::nullopt
                               : probe_histograms(options.histograms_folder))
    {
        return failure("--histograms: " + error->text);
    }
    return std::nullopt;
}

/// Guards of the devices that would hold their force after hrtc's death.
Result<Guardian::Guards, Refusal> make_guards(const Options& options)
{
    Guardian::Guards guards;
    for (const ToolOptions& tool : options.tools)
    {
        if (!wants_guard(tool.device))
        {
            continue;
        }
        auto guard = open_guard(tool.device, options.rate_hz);
        if (!guard)
        {
            return guard.error();
        }
        if (guard.value() != nullptr)
        {
            guards.push_back(std::move(guard).value());
        }
    }
    return guards;
}

void report_unguarded(const Options& options)
{
    for (std::size_t tool = 0; tool < options.tools.size(); ++tool)
    {
        const DeviceChoice& choice = options.tools[tool].device;
        if (choice.kind == DeviceKind::plugin && !has_guard(choice.library))
        {
            log_line(fmt::format("tool {}: {} has no guard; if hrtc is killed, only the watchdog "
                                 "of the device can end the force",
                                 tool, choice.library));
        }
    }
}

/// Starts the guardian; null if no device needs one.
Result<std::unique_ptr<Guardian>, Refusal> start_guardian(const Options& options)
{
    if (!options.has_guardian ||
        std::ranges::none_of(options.tools, wants_guard, &ToolOptions::device))
    {
        return std::unique_ptr<Guardian>();
    }
    auto guardian = Guardian::start([&options] { return make_guards(options); },
                                    options.thread.priority, options.thread.allow_no_rt);
    if (!guardian)
    {
        return failure("--device: " + guardian.error().text);
    }
    return guardian;
}

} // namespace

Session::Session(const Options& options, RunHooks hooks)
    : options_(options), hooks_(std::move(hooks))
{
}

Session::~Session() = default;

Result<std::unique_ptr<Session>, Refusal> Session::open(const Options& options, RunHooks hooks)
{
    if (auto error = options.is_stepped ? std::nullopt : check_machine(options))
    {
        return *error;
    }
    if (auto error = check_outputs(options))
    {
        return *error;
    }
    if (options.thread.cpu) // This thread starts all others, including those of DDS.
    {
        linux_extras::keep_calling_thread_off(*options.thread.cpu);
    }
    auto guardian = start_guardian(options);
    if (!guardian)
    {
        return guardian.error();
    }
    std::unique_ptr<Session> session(new Session(options, std::move(hooks)));
    session->guardian_ = std::move(guardian).value();
    if (auto error = session->connect())
    {
        return *error;
    }
    if (auto error = session->take_scene())
    {
        return *error;
    }
    if (auto error = take_tool_files(session->options_))
    {
        return *error;
    }
    if (auto error = session->assemble())
    {
        return *error;
    }
    report_unguarded(session->options_);
    return session;
}

/// Connects to servers and viewers. Does nothing if options_.is_watched is false.
std::optional<Refusal> Session::connect()
{
    if (options_.is_watched)
    {
        const bool has_keys = !options_.security.keys.empty();
        const bool is_protected = has_keys || options_.security.is_required;
        const std::string name =
            options_.name.empty() && !has_keys ? fmt::format("hrtc-{}", getpid()) : options_.name;
        auto client = dds::DdsClient::create({options_.domain, options_.security}, name, log_line);
        if (!client && options_.transport == TransportKind::file && !is_protected)
        {
            log_line(client.error().text + "; viewers can't see the run");
            return std::nullopt;
        }
        if (!client)
        {
            return failure(client.error().text);
        }
        client_ = std::move(client).value();
    }
    return std::nullopt;
}

/// Loads the scene of a file or a server; without --scene does nothing but make the reader of
/// poses.
std::optional<Refusal> Session::take_scene()
{
    const bool has_servers = options_.transport == TransportKind::dds;
    if (has_servers && (options_.follows_poses || !options_.scene.empty()))
    {
        reader_ =
            std::make_unique<dds::SceneReader>(client_->domain(), client_->exchange(), log_line);
    }
    if (options_.scene.empty())
    {
        return std::nullopt;
    }
    if (!has_servers)
    {
        return take_scene_file(options_);
    }
    auto shown = take_shown_scene(options_, *client_, *reader_, [this] { return goes_on(); });
    if (!shown)
    {
        return shown.error();
    }
    scene_ = std::move(shown).value();
    pin({scene_.name}, true, scene_.server_epoch);
    return std::nullopt;
}

/// Adds an authority for the model or scene `name`, held by the server of that epoch.
void Session::pin(const ModelSelector& name, bool is_scene, std::uint64_t server_epoch)
{
    authorities_.emplace_back(client_->catalogue(), name, is_scene, options_.failover, log_line)
        .pin(server_epoch);
}

/// Finds the models, and makes the controller and the topics.
std::optional<Refusal> Session::assemble()
{
    const bool has_servers = options_.transport == TransportKind::dds;
    auto models = has_servers ? find_published(options_, *client_, [this] { return goes_on(); })
                              : find_in_files(options_);
    if (!models)
    {
        return models.error();
    }
    for (const ServedModel& model : models.value())
    {
        if (has_servers && options_.scene.empty())
        {
            pin({model.name, model.hash}, false, model.server_epoch);
        }
    }
    if (reader_ != nullptr && options_.scene.empty())
    {
        take_first_places(options_, models.value(), *client_, *reader_,
                          [this] { return goes_on(); });
    }
    auto controller = Controller::create(options_, std::move(models).value(), log_line,
                                         [this] { return goes_on(); });
    if (!controller)
    {
        return failure(controller.error().text);
    }
    controller_ = std::move(controller).value();
    return client_ != nullptr ? connect_topics(has_servers) : std::nullopt;
}

/// Connects the controller with the topics of its servers and viewers.
std::optional<Refusal> Session::connect_topics(bool has_servers)
{
    std::unique_ptr<SceneKeeper> keeper;
    if (has_servers && options_.follows_poses)
    {
        keeper = std::make_unique<SceneKeeper>(authorities_, std::move(reader_),
                                               controller_->scene_parts(), scene_, log_line);
    }
    auto topics = ServerTopics::create(*client_, *controller_, authorities_, std::move(keeper),
                                       options_.shows_refinement_state, log_line);
    if (!topics)
    {
        return failure(topics.error().text);
    }
    topics_ = std::move(topics).value();
    auto cuts =
        has_servers ? CutSender::create(*controller_, options_) : std::unique_ptr<CutSender>();
    if (!cuts)
    {
        return failure(cuts.error().text);
    }
    if (cuts.value() != nullptr && !topics_->has_edits())
    {
        return failure("--edit: no model can be edited; start its server with --edits");
    }
    if (cuts.value() != nullptr)
    {
        topics_->add_cuts(std::move(cuts).value());
    }
    for (std::uint32_t i = 0; i < options_.objects.size(); ++i)
    {
        topics_->name_object(i, options_.objects[i].name);
    }
    return std::nullopt;
}

void Session::name_object(std::uint32_t number, const std::string& name)
{
    if (topics_ != nullptr)
    {
        topics_->name_object(number, name);
    }
}

std::optional<Refusal> Session::start(ProgramScene* program, HandTap* hands,
                                      const ProgramEdits& edits)
{
    if (const auto error = start_recorder(options_, *controller_, recorder_))
    {
        return failure(*error);
    }
    if (const auto error = start_trace(options_, trace_))
    {
        return failure(*error);
    }
    run_ = std::make_unique<SessionRun>(RunParts{.options = options_,
                                                 .controller = *controller_,
                                                 .topics = topics_.get(),
                                                 .recorder = recorder_ ? &*recorder_ : nullptr,
                                                 .trace = trace_ ? &*trace_ : nullptr,
                                                 .guardian = guardian_.get(),
                                                 .hooks = hooks_,
                                                 .program = program,
                                                 .hands = hands,
                                                 .edits = edits});
    return run_->start();
}

FinishedRun Session::finish()
{
    FinishedRun done = run_->finish();
    run_.reset();
    return done;
}

Result<FinishedRun, Refusal> Session::run(const std::string& what)
{
    if (auto error = start())
    {
        return *error;
    }
    run_->wait(what);
    return finish();
}

} // namespace tactus::hrtc
