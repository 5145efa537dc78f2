// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/run_statistics.hpp"
#include "platform/machine/time.hpp"
#include "rt_core/base/mailbox.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/math/similarity.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/device_record.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/scene/object_table.hpp"
#include "transport/telemetry.hpp"

#include <atomic>
#include <cstdint>
#include <span>

namespace tactus::hrtc
{

/// Copy of the poses of objects at the end of one frame, with the controller's numbers.
struct ObjectsCopy
{
    struct Object
    {
        std::uint32_t number{0};
        std::uint32_t model{0};
        Similarity pose; ///< Pose of the model's frame.
    };

    std::uint32_t sweep_begin{0}; ///< Range as in ObjectsTelemetry.
    std::uint32_t sweep_end{0};
    StaticVector<Object, kMaxShownObjects> objects;
};

/// Copies the poses of objects for viewers. The copy belongs to one thread at a time: the haptic
/// thread fills it; the transport thread reads it and gives it back. Neither ever waits.
class ObjectTap
{
public:
    /// Haptic thread, after a frame: makes a copy if the last one was given back. Allocates
    /// nothing; about 0.1 us, and 10 ns for each object of the copy.
    void show(const ObjectTable& objects, std::span<const PairOutput> pairs) noexcept
    {
        if (!is_out_.load(std::memory_order_acquire)) // Pairs with the release in give_back().
        {
            copy(objects, pairs);
            is_out_.store(true, std::memory_order_release); // Pairs with the acquire in take().
        }
    }

    /// Transport thread: the copy, valid until give_back(); null if there is none.
    [[nodiscard]] const ObjectsCopy* take() const noexcept
    {
        // Pairs with the release in show().
        return is_out_.load(std::memory_order_acquire) ? &copy_ : nullptr;
    }
    /// Transport thread, only after take() returned a copy. If the copy `was_sent`, the next one
    /// has the following range of numbers, else the same range again.
    void give_back(bool was_sent) noexcept
    {
        was_sent_ = was_sent;
        is_out_.store(false, std::memory_order_release); // Pairs with the acquire in show().
    }

private:
    void copy(const ObjectTable& objects, std::span<const PairOutput> pairs) noexcept;
    void add(const ObjectTable& objects, std::uint32_t number) noexcept;

    std::atomic<bool> is_out_{false};
    bool was_sent_{false}; ///< Belongs to the owner of the copy.
    ObjectsCopy copy_;
};

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
