// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/controller/refinement_state_source.hpp"
#include "platform/controller/run_results.hpp"
#include "platform/machine/time.hpp"
#include "platform/scene/scene_keeper.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/math/vec3.hpp"
#include "transport/base/refusal.hpp"
#include "transport/dds/authority.hpp"
#include "transport/dds/edit_reader.hpp"
#include "transport/dds/refusals.hpp"
#include "transport/dds/telemetry.hpp"
#include "transport/log.hpp"

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus
{

class EditMailbox;
class SceneMailbox;

} // namespace tactus

namespace tactus::dds
{

class DdsClient;

} // namespace tactus::dds

namespace tactus::hrtc
{

class Controller;
class CutSender;
class CutTap;
class TelemetryTap;

/// Topics between a controller and its servers and viewers, except those of models. Servers move
/// objects; the controller publishes its state. Runs on the transport thread and can't delay the
/// loop.
class ServerTopics
{
public:
    /// Period in which the controller's state is sent.
    static constexpr Duration kTelemetryPeriod = milliseconds(10);
    /// Time before a sample at which the haptic thread is asked for new poses of objects.
    static constexpr Duration kRenewal = milliseconds(2);

    /// `client`, `controller` and `authorities` must outlive the topics. Without `keeper`, the
    /// poses and scenes of servers are ignored. The refinement state is sent if
    /// `shows_refinement_state` is set. `log` gets, at a limited rate, a line for each refused
    /// edit.
    [[nodiscard]] static Result<std::unique_ptr<ServerTopics>, Refusal>
    create(dds::DdsClient& client, const Controller& controller,
           std::span<dds::Authority> authorities, std::unique_ptr<SceneKeeper> keeper,
           bool shows_refinement_state, const Log& log);

    ServerTopics(const ServerTopics&) = delete;
    ServerTopics& operator=(const ServerTopics&) = delete;
    ~ServerTopics();

    /// Connects the topics to the mailbox and taps of the haptic thread, which must live as long as
    /// the run. `states` may be null if shows_refinement_state() is false. `names` receives the
    /// names of objects added later, and may be empty. `edits` may be null if has_edits() is false.
    void connect(SceneMailbox& mailbox, EditMailbox* edits, TelemetryTap& tap,
                 RefinementStateTap* states, MonotonicTime now, SceneKeeper::NameSink names = {});
    /// Reports to viewers that the tool began inside a closed object. Any thread.
    void tell_begins_inside(std::size_t tool) noexcept;
    /// Names an object for viewers; others have the names of their models. Any thread but the
    /// haptic one.
    void name_object(std::uint32_t number, const std::string& name);
    /// Sends the edit requests of the tools that carve; has_edits() must be true (asserted). Call
    /// it before the run.
    void add_cuts(std::unique_ptr<CutSender> cuts) noexcept;
    /// Tap of the tools that carve; null without any.
    [[nodiscard]] CutTap* cut_tap() noexcept;
    /// True if a model of a server has room for faces that edits add.
    [[nodiscard]] bool has_edits() const noexcept { return edits_ != nullptr; }
    [[nodiscard]] bool shows_refinement_state() const noexcept { return states_.has_value(); }

    /// Passes poses to the mailbox, and publishes telemetry, with the refinement state as an
    /// optional part, when its period has passed. Transport thread, after the chunk loader's round.
    void step(MonotonicTime now);

    /// Counts of poses, one entry a model; empty if poses aren't followed. Not during a step.
    [[nodiscard]] std::vector<dds::PoseCounts> pose_counts() const;
    /// Counts of the changes of the servers' objects; zero if poses aren't followed.
    [[nodiscard]] SceneNewsCounts scene_news() const;
    /// Counts of edits, one entry a model; empty if no model can be edited. Not during a step.
    [[nodiscard]] std::vector<dds::EditReader::Counts> edit_counts() const;
    /// Counts of the edit requests of the tools that carve; none without any. Not during a step.
    [[nodiscard]] std::optional<CutCounts> cut_counts() const;
    /// Refused messages of other participants of the domain.
    [[nodiscard]] std::vector<dds::PeerRefusals> refused() const;
    /// Events of the servers with authority, in order of time.
    [[nodiscard]] std::vector<dds::ServerEvent> server_events() const;
    [[nodiscard]] std::uint64_t telemetry_sent() const noexcept { return telemetry_->sent(); }
    [[nodiscard]] std::uint64_t states_sent() const noexcept { return telemetry_->states_sent(); }

private:
    /// Number of pieces of one model, and the sum of their waiting times, when telemetry was last
    /// sent.
    struct Seen
    {
        std::uint64_t pieces{0};
        std::int64_t wait_ns{0};
    };

    ServerTopics(const dds::DdsClient& client, const Controller& controller,
                 std::span<dds::Authority> authorities, std::unique_ptr<SceneKeeper> keeper,
                 const Log& log);

    [[nodiscard]] std::uint64_t server_of(std::size_t model) const;
    void pass_edits();
    [[nodiscard]] bool try_request(std::size_t model, EditRequest request);
    void send_telemetry(MonotonicTime now);
    void add_transport_side(std::size_t model, ModelTelemetry& telemetry, MonotonicTime now);
    void name_server(std::uint64_t& server_epoch, std::uint32_t& object) const;
    void renew_objects(bool was_sent);
    [[nodiscard]] ObjectsTelemetry take_objects();

    const dds::DdsClient& client_;
    const Controller& controller_;
    std::span<dds::Authority> authorities_;
    std::unique_ptr<SceneKeeper> keeper_;    ///< Null if poses aren't followed.
    std::unique_ptr<dds::EditReader> edits_; ///< Null if no model can be edited.
    std::unique_ptr<CutSender> cuts_;        ///< Null if no tool carves.
    dds::EditWriter requests_;
    EditMailbox* edit_mailbox_{nullptr};
    std::unique_ptr<dds::TelemetryWriter> telemetry_;
    std::optional<RefinementStateSource> states_; ///< None if no viewer gets states.
    TelemetryTap* tap_{nullptr};
    /// True if the copy of the objects' poses was made while there was a reader.
    bool has_new_objects_{false};
    bool is_renewed_{false};      ///< True if the copy was renewed since the last sample.
    std::vector<Vec3> origins_m_; ///< Origin of each model's frame in its source mesh.
    std::mutex names_mutex_;      ///< Guards names_.
    std::map<std::uint32_t, std::string> names_; ///< Names of objects, by their numbers.
    MonotonicTime last_sent_{};
    std::vector<Seen> seen_;
};

} // namespace tactus::hrtc
