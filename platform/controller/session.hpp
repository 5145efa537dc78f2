// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/run_options.hpp"
#include "platform/controller/recorder.hpp"
#include "platform/controller/run_hooks.hpp"
#include "platform/controller/trace_file.hpp"
#include "platform/scene/scene_choice.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"
#include "transport/dds/authority.hpp"
#include "transport/model_name.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::dds
{

class DdsClient;
class SceneReader;

} // namespace tactus::dds

namespace tactus::hrtc
{

class Controller;
class Guardian;
class HandTap;
class ProgramScene;
class ServerTopics;
class SessionRun;
struct FinishedRun;

/// Session of one run: finds the models of the options and assembles a controller for them.
class Session
{
public:
    /// Checks the machine (probe_realtime()) and outputs, finds the models and assembles the
    /// controller. Waits at most options.wait_s for models that aren't published yet.
    [[nodiscard]] static Result<std::unique_ptr<Session>, Refusal> open(const Options& options,
                                                                        RunHooks hooks = {});

    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;
    ~Session();

    /// Options given to open(), with the objects, models and places of the scene added.
    [[nodiscard]] const Options& options() const noexcept { return options_; }
    [[nodiscard]] Controller& controller() noexcept { return *controller_; }
    [[nodiscard]] const Controller& controller() const noexcept { return *controller_; }

    /// Starts the loop on its real-time thread beside the supervisor, the transport and the
    /// recorder; with Options::is_stepped without any of these threads. `program` and `hands` may
    /// be null, and `edits` empty; they must outlive the session. Returns the reason if it can't
    /// start. Call it once.
    [[nodiscard]] std::optional<Refusal> start(ProgramScene* program = nullptr,
                                               HandTap* hands = nullptr,
                                               const ProgramEdits& edits = {});
    /// Names an object for viewers. Any thread but the haptic one, before the session is destroyed.
    void name_object(std::uint32_t number, const std::string& name);
    /// The run after start() and before finish().
    [[nodiscard]] SessionRun& running() noexcept { return *run_; }
    /// Ends the run after SessionRun::wait(), or between two steps, and returns its results.
    [[nodiscard]] FinishedRun finish();

    /// Runs the loop on its real-time thread beside the supervisor, the transport and the recorder,
    /// and waits for its end. The hooks may end the run early; forces fade then. `what` is the
    /// run's name for the hooks. If an assertion fails, the devices are braked and the process ends
    /// with exit code 2 (assertion_brake.hpp). Call it once.
    [[nodiscard]] Result<FinishedRun, Refusal> run(const std::string& what);

private:
    Session(const Options& options, RunHooks hooks);

    [[nodiscard]] bool goes_on() const { return hooks_.goes_on(); }

    [[nodiscard]] std::optional<Refusal> connect();
    [[nodiscard]] std::optional<Refusal> take_scene();
    void pin(const ModelSelector& name, bool is_scene, std::uint64_t server_epoch);
    [[nodiscard]] std::optional<Refusal> assemble();
    [[nodiscard]] std::optional<Refusal> connect_topics(bool has_servers);

    /// Guardian, which must outlive the devices; null if no device needs one.
    std::unique_ptr<Guardian> guardian_;
    Options options_;
    RunHooks hooks_;
    /// Must outlive the links of its models; null without DDS.
    std::unique_ptr<dds::DdsClient> client_;
    /// Null unless needed; moved to the scene keeper in assemble().
    std::unique_ptr<dds::SceneReader> reader_;
    ShownScene scene_; ///< Scene of a server; without a name otherwise.
    /// Authority of the scene, or one a model; empty for files.
    std::vector<dds::Authority> authorities_;
    std::unique_ptr<Controller> controller_;
    std::unique_ptr<ServerTopics> topics_; ///< Null without a client.
    std::optional<Recorder> recorder_;     ///< None without a recording.
    std::optional<TraceFile> trace_;       ///< None without a trace.
    std::unique_ptr<SessionRun> run_;      ///< Null before start() and after finish().
};

} // namespace tactus::hrtc
