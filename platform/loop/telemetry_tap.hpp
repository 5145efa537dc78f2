// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/object_tap.hpp"
#include "platform/loop/run_statistics.hpp"
#include "platform/machine/time.hpp"
#include "rt_core/base/mailbox.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/device_record.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/scene/object_table.hpp"
#include "transport/telemetry.hpp"

#include <span>

namespace tactus::hrtc
{

/// Data of one frame for display.
struct ShownFrame
{
    MonotonicTime start;
    std::span<const ToolState> tools;
    std::span<const DeviceRecord> devices; ///< Device records, one a tool.
    std::span<const double> radii_m;       ///< Tool radii, one a tool.
    const FrameOutput& output;
    const ObjectTable& objects;
};

/// Passes every frame's telemetry through a mailbox; the haptic thread never waits for readers.
class TelemetryTap
{
public:
    explicit TelemetryTap(Duration period) { news_.period_ns = period.ns; }

    /// Haptic thread, after the forces are written and the statistics updated. Allocates nothing;
    /// about 0.6 us, and 0.2 us for each tool that touches several objects; see also ObjectTap.
    void show(const ShownFrame& frame, const RunStatistics& statistics) noexcept;

    /// Any thread: copies the newest frame into `telemetry`. Before the first frame returns false
    /// and leaves `telemetry` unchanged. Fields that only the transport thread knows (servers,
    /// poses, chunks) are zero; objects have the controller's numbers.
    [[nodiscard]] bool try_read(Telemetry& telemetry) const noexcept
    {
        return mailbox_.try_read(telemetry);
    }
    /// Poses of the objects, for the transport thread.
    [[nodiscard]] ObjectTap& objects() noexcept { return objects_; }

private:
    void show_pairs(const ShownFrame& frame) noexcept;

    Telemetry news_; ///< Newest telemetry; haptic thread only.
    Mailbox<Telemetry> mailbox_;
    ObjectTap objects_;
};

/// Shares `push_n`, the push of one tool on all objects, among the objects of its pairs; world
/// frame. `radius_m`: the tool's radius. Objects within 1 mm of the tool, in the push's direction,
/// count as touched. Each gets the part that fits its normal best, none pulls, and the rest
/// (friction) is shared in proportion. If none counts, the nearest object gets all. `pushes_n` gets
/// one push a pair, 0 without touch; their sum is `push_n`. Allocates nothing; 0.02 us for one
/// touched object, 0.2 us for several.
void share_push(std::span<const PairOutput> pairs, double radius_m, const Vec3& push_n,
                std::span<Vec3> pushes_n) noexcept;

} // namespace tactus::hrtc
