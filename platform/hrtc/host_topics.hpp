// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/base/refusal.hpp"
#include "platform/hrtc/controller.hpp"
#include "platform/hrtc/telemetry_tap.hpp"
#include "platform/remote/pose_door.hpp"
#include "platform/time.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/dds/poses.hpp"
#include "transport/dds/telemetry.hpp"

#include <cstdint>
#include <memory>
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

    /// `client` and `controller` must outlive it. Poses are passed over unless `follows_poses`.
    [[nodiscard]] static Result<std::unique_ptr<HostTopics>, Refusal>
    create(const dds::DdsClient& client, const Controller& controller, bool follows_poses);

    /// Between these two and the haptic thread; both live as long as the run.
    void connect(PoseDoor& door, const TelemetryTap& tap) noexcept;

    /// The transport thread, after the couriers' round: poses to the door, telemetry when it is
    /// due.
    void step(MonotonicTime now);

    /// One an object; none when poses are passed over. While no step is under way.
    [[nodiscard]] std::vector<dds::PoseCounts> pose_counts() const;
    [[nodiscard]] std::uint64_t telemetry_sent() const noexcept { return telemetry_->sent(); }

private:
    /// What of one model's pieces was known when telemetry was last sent.
    struct Seen
    {
        std::uint64_t pieces{0};
        std::int64_t wait_ns{0};
    };

    explicit HostTopics(const Controller& controller);

    void take_poses(MonotonicTime now);
    void send_telemetry();
    void add_transport_side(std::size_t model, ModelTelemetry& telemetry);

    const Controller& controller_;
    std::vector<ModelHeader> headers_; ///< Views into the controller's models.
    std::unique_ptr<dds::PoseReader> poses_;
    std::unique_ptr<dds::TelemetryWriter> telemetry_;
    PoseDoor* door_{nullptr};
    const TelemetryTap* tap_{nullptr};
    MonotonicTime last_sent_{};
    std::vector<Seen> seen_;
};

} // namespace tactus::hrtc
