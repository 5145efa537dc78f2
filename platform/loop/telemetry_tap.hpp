// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/run_statistics.hpp"
#include "platform/machine/time.hpp"
#include "rt_core/base/mailbox.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/device_record.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"
#include "transport/telemetry.hpp"

#include <span>

namespace tactus::hrtc
{

/// What the haptic thread shows of one frame.
struct ShownFrame
{
    MonotonicTime start;
    std::span<const ToolState> tools;
    std::span<const DeviceRecord> devices; ///< One a tool.
    std::span<const double> radii_m;       ///< Likewise.
    const FrameOutput& output;
};

/// Shows every frame to whoever looks, through a mailbox: the haptic thread never waits and never
/// knows whether anybody does.
class TelemetryTap
{
public:
    explicit TelemetryTap(Duration period) { news_.period_ns = period.ns; }

    /// The haptic thread, after the forces have gone out and the statistics have the frame.
    /// Allocates nothing; some 0.6 us, and 0.2 us a tool that touches several objects.
    void show(const ShownFrame& frame, const RunStatistics& statistics) noexcept;

    /// Any thread: the newest frame; false, with `telemetry` as it was, before the first one. What
    /// only the transport knows (hosts, poses, pieces) is left zero, objects have the
    /// controller's numbers.
    [[nodiscard]] bool try_read(Telemetry& telemetry) const noexcept
    {
        return mailbox_.try_read(telemetry);
    }

private:
    void show_pairs(const ShownFrame& frame) noexcept;

    Telemetry news_; ///< The haptic thread's.
    Mailbox<Telemetry> mailbox_;
};

} // namespace tactus::hrtc
