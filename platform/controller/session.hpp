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

/// The models that the options name and a controller that touches them, for one run.
class Session
{
public:
    /// Tries what the options ask of the machine (probe_realtime()), finds the models, waiting for
    /// those that nobody publishes yet, and assembles the controller.
    [[nodiscard]] static Result<std::unique_ptr<Session>, Refusal> open(const Options& options,
                                                                        RunHooks hooks = {});

    /// With the objects and models of the scene, and their places.
    [[nodiscard]] const Options& options() const noexcept { return options_; }
    [[nodiscard]] Controller& controller() noexcept { return *controller_; }
    [[nodiscard]] const Controller& controller() const noexcept { return *controller_; }

    /// Runs the loop on its real-time thread with the supervisor, the transport and the recorder
    /// beside it, and waits for its end; the hooks may end it early, forces fading. Once.
    /// `what` names it for them. When an assertion fails in the run, the devices are
    /// braked and the process ends here with exit code 2 (assertion_brake.hpp).
    [[nodiscard]] Result<FinishedRun, Refusal> run(const std::string& what);

private:
    Session(const Options& options, RunHooks hooks) : options_(options), hooks_(std::move(hooks)) {}

    [[nodiscard]] bool goes_on() const { return hooks_.goes_on(); }

    [[nodiscard]] std::optional<Refusal> connect();
    [[nodiscard]] std::optional<Refusal> take_scene();
    void pin(const ModelSelector& name, bool is_scene, std::uint64_t host_epoch);
    [[nodiscard]] std::optional<Refusal> assemble();

    std::unique_ptr<Guardian> guardian_; ///< Outlives the devices; none where none needs it.
    Options options_;
    RunHooks hooks_;
    std::unique_ptr<dds::DdsClient> client_;   ///< Lives as long as the links of its models.
    std::unique_ptr<dds::SceneReader> reader_; ///< Until the topics have it; none unless needed.
    ShownScene scene_;                         ///< Of a host; empty otherwise.
    std::vector<dds::Authority> authorities_;  ///< Of the scene, or one a model; none from files.
    std::unique_ptr<Controller> controller_;
    std::unique_ptr<HostTopics> topics_; ///< None from files.
};

} // namespace tactus::hrtc
