// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/messages.hpp"
#include "platform/choices/run_options.hpp"
#include "platform/controller/controller.hpp"
#include "platform/controller/finished_run.hpp"
#include "platform/controller/guardian.hpp"
#include "platform/controller/host_topics.hpp"
#include "platform/controller/run_hooks.hpp"
#include "platform/scene/scene_choice.hpp"
#include "transport/base/refusal.hpp"
#include "transport/dds/authority.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/dds/scene_reader.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::hrtc
{

/// Session of one run: the models of the options, and a controller for them.
class Session
{
public:
    /// Checks the machine (probe_realtime()), finds the models and assembles the controller. Waits
    /// for models that aren't published yet.
    [[nodiscard]] static Result<std::unique_ptr<Session>, Refusal> open(const Options& options,
                                                                        RunHooks hooks = {});

    /// Options, completed by the scene's objects, models and places.
    [[nodiscard]] const Options& options() const noexcept { return options_; }
    [[nodiscard]] Controller& controller() noexcept { return *controller_; }
    [[nodiscard]] const Controller& controller() const noexcept { return *controller_; }

    /// Runs the loop on its real-time thread beside the supervisor, the transport and the recorder,
    /// and waits for its end. The hooks may end it early; forces fade then. `what` is the run's
    /// name for the hooks. If an assertion fails, the devices are braked and the process ends with
    /// exit code 2 (assertion_brake.hpp). Once.
    [[nodiscard]] Result<FinishedRun, Refusal> run(const std::string& what);

private:
    Session(const Options& options, RunHooks hooks) : options_(options), hooks_(std::move(hooks)) {}

    [[nodiscard]] bool goes_on() const { return hooks_.goes_on(); }

    [[nodiscard]] std::optional<Refusal> connect();
    [[nodiscard]] std::optional<Refusal> take_scene();
    void pin(const ModelSelector& name, bool is_scene, std::uint64_t host_epoch);
    [[nodiscard]] std::optional<Refusal> assemble();

    std::unique_ptr<Guardian> guardian_; ///< Outlives the devices; null if none needs a guardian.
    Options options_;
    RunHooks hooks_;
    std::unique_ptr<dds::DdsClient> client_;   ///< Lives as long as the links of its models.
    std::unique_ptr<dds::SceneReader> reader_; ///< Null unless needed; given to the scene keeper.
    ShownScene scene_;                         ///< Scene of a host; empty otherwise.
    std::vector<dds::Authority> authorities_;  ///< Authority of the scene, or one a model; none
                                               ///< from files.
    std::unique_ptr<Controller> controller_;
    std::unique_ptr<HostTopics> topics_; ///< Null without a client.
};

} // namespace tactus::hrtc
