// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/base/refusal.hpp"
#include "platform/hrtc/controller.hpp"
#include "platform/hrtc/telemetry_tap.hpp"
#include "platform/remote/pose_door.hpp"
#include "platform/time.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/dds/scene_reader.hpp"
#include "transport/dds/telemetry.hpp"

#include <cstdint>
#include <memory>
#include <optional>
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

    /// `client` and `controller` must outlive it. What hosts show is passed over unless
    /// `follows_poses`.
    [[nodiscard]] static Result<std::unique_ptr<HostTopics>, Refusal>
    create(dds::DdsClient& client, const Controller& controller, bool follows_poses);

    /// Between these two and the haptic thread; both live as long as the run.
    void connect(PoseDoor& door, const TelemetryTap& tap) noexcept;

    /// The transport thread, after the couriers' round: poses to the door, telemetry when it is
    /// due.
    void step(MonotonicTime now);

    /// One a model; none when what hosts show is passed over. While no step is under way.
    [[nodiscard]] std::vector<dds::PoseCounts> pose_counts() const;
    [[nodiscard]] std::uint64_t telemetry_sent() const noexcept { return telemetry_->sent(); }

private:
    /// What of one model's pieces was known when telemetry was last sent.
    struct Seen
    {
        std::uint64_t pieces{0};
        std::int64_t wait_ns{0};
    };
    /// Which of a host's objects moves the first of ours that shows the model: of those with that
    /// model the one with the least number.
    struct Followed
    {
        std::uint64_t host_epoch{0};         ///< Of the host that serves the model; 0: nobody does.
        std::optional<std::uint32_t> object; ///< Its number there.
        dds::PoseCounts known;               ///< What is in `counts` of this object.
        dds::PoseCounts counts;              ///< Of all that were followed.
        MonotonicTime heard{};
    };

    HostTopics(dds::DdsClient& client, const Controller& controller);

    void choose_hosts();
    void take_news(dds::SceneNews news, const dds::SeenObject& object, MonotonicTime now);
    void follow(std::size_t model, const dds::SeenObject& object, MonotonicTime now);
    void hear(MonotonicTime now);
    void send_telemetry(MonotonicTime now);
    void add_transport_side(std::size_t model, ModelTelemetry& telemetry, MonotonicTime now);
    void name_object(PairTelemetry& pair) const;

    const dds::Catalogue& catalogue_;
    const Controller& controller_;
    std::vector<ModelHeader> headers_; ///< Views into the controller's models.
    std::optional<dds::SceneReader> scene_;
    std::uint64_t seen_catalogue_{0};
    std::vector<std::uint64_t> hosts_; ///< That serve our models.
    std::vector<Followed> followed_;   ///< One a model.
    std::vector<std::uint32_t> moved_; ///< The object of ours that each model's is.
    std::unique_ptr<dds::TelemetryWriter> telemetry_;
    PoseDoor* door_{nullptr};
    const TelemetryTap* tap_{nullptr};
    MonotonicTime last_sent_{};
    std::vector<Seen> seen_;
};

} // namespace tactus::hrtc
