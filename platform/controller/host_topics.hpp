// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/controller/controller.hpp"
#include "platform/controller/refinement_state_sender.hpp"
#include "platform/loop/scene_mailbox.hpp"
#include "platform/loop/telemetry_tap.hpp"
#include "platform/machine/time.hpp"
#include "platform/scene/scene_keeper.hpp"
#include "transport/base/refusal.hpp"
#include "transport/dds/authority.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/dds/telemetry.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace tactus::hrtc
{

/// What a controller and its hosts tell each other besides the models: the hosts move objects, the
/// controller shows what it does. Runs on the transport thread; nothing of it can hold up the loop.
class HostTopics
{
public:
    /// How often the controller's state is sent.
    static constexpr Duration kTelemetryPeriod = milliseconds(10);

    /// `client`, `controller` and `authorities`, those of the keeper, must outlive it. What hosts
    /// show is passed over without `keeper`, what is refined is told unless
    /// `shows_refinement_state` is false.
    [[nodiscard]] static Result<std::unique_ptr<HostTopics>, Refusal>
    create(dds::DdsClient& client, const Controller& controller,
           std::span<dds::Authority> authorities, std::unique_ptr<SceneKeeper> keeper,
           bool shows_refinement_state);

    /// Between these and the haptic thread; all live as long as the run. `front` may be null where
    /// shows_refinement_state() is false; `names` is the keeper's.
    void connect(SceneMailbox& queues, const TelemetryTap& tap, RefinementStateTap* front,
                 MonotonicTime now, SceneKeeper::NameSink names = {});
    /// Any thread: viewers are told that the tool began inside a closed object.
    void tell_begins_inside(std::size_t tool) noexcept;
    [[nodiscard]] bool shows_refinement_state() const noexcept { return front_ != nullptr; }

    /// The transport thread, after the chunk loaders' round: poses to the mailbox, telemetry
    /// and refinement state when they are due.
    void step(MonotonicTime now);

    /// One a model; none when what hosts show is passed over. While no step is under way.
    [[nodiscard]] std::vector<dds::PoseCounts> pose_counts() const;
    /// Of a scene that is followed.
    [[nodiscard]] SceneNewsCounts scene_news() const;
    /// What others on the domain said in vain.
    [[nodiscard]] std::vector<dds::PeerRefusals> refused() const
    {
        return client_.domain().participants().refusals().list();
    }
    /// What became of the servers whose word counts, in order.
    [[nodiscard]] std::vector<dds::ServerEvent> server_events() const;
    [[nodiscard]] std::uint64_t telemetry_sent() const noexcept { return telemetry_->sent(); }
    [[nodiscard]] std::uint64_t states_sent() const noexcept
    {
        return front_ != nullptr ? front_->sent() : 0;
    }

private:
    /// What of one model's pieces was known when telemetry was last sent.
    struct Seen
    {
        std::uint64_t pieces{0};
        std::int64_t wait_ns{0};
    };

    HostTopics(const dds::DdsClient& client, const Controller& controller,
               std::span<dds::Authority> authorities, std::unique_ptr<SceneKeeper> keeper);

    void send_telemetry(MonotonicTime now);
    void add_transport_side(std::size_t model, ModelTelemetry& telemetry, MonotonicTime now);
    void name_object(PairTelemetry& pair) const;

    const dds::DdsClient& client_;
    const Controller& controller_;
    std::span<dds::Authority> authorities_;
    std::unique_ptr<SceneKeeper> keeper_; ///< May be none.
    std::unique_ptr<dds::TelemetryWriter> telemetry_;
    std::unique_ptr<RefinementStateSender> front_; ///< Likewise.
    const TelemetryTap* tap_{nullptr};
    MonotonicTime last_sent_{};
    std::vector<Seen> seen_;
};

} // namespace tactus::hrtc
