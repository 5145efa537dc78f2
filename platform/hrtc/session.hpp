// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/base/refusal.hpp"
#include "platform/hrtc/controller.hpp"
#include "platform/hrtc/finished_run.hpp"
#include "platform/hrtc/guardian.hpp"
#include "platform/hrtc/host_topics.hpp"
#include "platform/hrtc/messages.hpp"
#include "platform/hrtc/options.hpp"
#include "platform/hrtc/scene_choice.hpp"
#include "transport/dds/authority.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/dds/scene_reader.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::hrtc
{

/// The models that the options name and a controller that touches them, for one run.
class Session
{
public:
    /// Tries what the options ask of the machine (probe_realtime()), finds the models, waiting for
    /// those that nobody publishes yet, and assembles the controller.
    [[nodiscard]] static Result<std::unique_ptr<Session>, Refusal> open(const Options& options);

    /// With the objects and models of the scene, and their places.
    [[nodiscard]] const Options& options() const noexcept { return options_; }
    [[nodiscard]] Controller& controller() noexcept { return *controller_; }
    [[nodiscard]] const Controller& controller() const noexcept { return *controller_; }

    /// Runs the loop on its real-time thread with the supervisor, the transport and the recorder
    /// beside it, and waits for its end; a signal to end ends it early, forces fading. Once.
    /// `what` names it for the progress line. When an assertion fails in the run, the devices are
    /// braked and the process ends here with exit code 2 (assertion_brake.hpp).
    [[nodiscard]] Result<FinishedRun, Refusal> run(const std::string& what);

private:
    explicit Session(const Options& options) : options_(options) {}

    [[nodiscard]] std::optional<Refusal> connect();
    [[nodiscard]] std::optional<Refusal> take_scene();
    void pin(const ModelSelector& name, bool is_scene, std::uint64_t host_epoch);
    [[nodiscard]] std::optional<Refusal> assemble();

    std::unique_ptr<Guardian> guardian_; ///< Outlives the devices; none where none needs it.
    Options options_;
    std::unique_ptr<dds::DdsClient> client_;   ///< Lives as long as the links of its models.
    std::unique_ptr<dds::SceneReader> reader_; ///< Until the topics have it; none unless needed.
    ShownScene scene_;                         ///< Of a host; empty otherwise.
    std::vector<dds::Authority> authorities_;  ///< Of the scene, or one a model; none from files.
    std::unique_ptr<Controller> controller_;
    std::unique_ptr<HostTopics> topics_; ///< None from files.
};

} // namespace tactus::hrtc
