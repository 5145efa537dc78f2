// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/hrtc/run_statistics.hpp"
#include "platform/time.hpp"
#include "rt_core/base/mailbox.hpp"
#include "rt_core/math/vec3.hpp"
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
    std::span<const ToolForce> forces; ///< One a tool.
    std::span<const ObjectPose> poses;
    const FrameOutput& output;
};

/// Shows every frame to whoever looks, through a mailbox: the haptic thread never waits and never
/// knows whether anybody does.
class TelemetryTap
{
public:
    explicit TelemetryTap(Duration period) noexcept { news_.period_ns = period.ns; }

    /// The haptic thread, after the forces have gone out and the statistics have the frame.
    /// Allocates nothing; 0.07 us for a tool and a model,
    /// 0.13 us for four and eight.
    void show(const ShownFrame& frame, const RunStatistics& statistics) noexcept;

    /// Any thread: the newest frame; false, with `telemetry` as it was, before the first one. What
    /// only the transport knows (host, poses followed and refused, pieces) is left zero.
    [[nodiscard]] bool try_read(Telemetry& telemetry) const noexcept
    {
        return mailbox_.try_read(telemetry);
    }

private:
    Telemetry news_; ///< The haptic thread's.
    Mailbox<Telemetry> mailbox_;
};

} // namespace tactus::hrtc
