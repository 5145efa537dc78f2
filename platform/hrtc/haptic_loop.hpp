// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/budget_governor.hpp"
#include "platform/clock.hpp"
#include "platform/haptic_device.hpp"
#include "platform/hrtc/run_statistics.hpp"
#include "platform/periodic_timer.hpp"
#include "platform/recording/frame_tap.hpp"
#include "rt_core/frame/frame.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace tactus::hrtc
{

/// What the loop works on; all of it outlives the loop.
struct LoopParts
{
    Frame* frame{nullptr};
    std::span<const std::unique_ptr<HapticDevice>> devices; ///< One a tool.
    std::span<const ObjectPose> poses;
    PeriodicTimer* timer{nullptr};
    const Clock* clock{nullptr};
    Budgets budgets;                   ///< Of every frame, when there is no governor.
    BudgetGovernor* governor{nullptr}; ///< Chooses each frame's budgets; may be none.
    FrameTap* tap{nullptr};            ///< Takes every frame for a recording; may be none.
    std::uint64_t frames{0};           ///< How many to run.
};

/// The haptic thread's work: every period read the devices, run the frame, write the forces, keep
/// the measures. Nothing else happens on that thread.
class HapticLoop
{
public:
    HapticLoop(const LoopParts& parts, RunStatistics& statistics);

    /// Runs until all frames are done or stop() was called. The timer has been started. Allocates
    /// nothing.
    void run() noexcept;

    /// Any thread: ends the loop after the present frame.
    void stop() noexcept { stopped_.store(true, std::memory_order_relaxed); }
    /// Any thread: whether the haptic thread has failed an assertion; the devices are braked then.
    [[nodiscard]] bool has_failed() const noexcept { return failed_.load(); }
    [[nodiscard]] bool is_done() const noexcept { return done_.load(); }
    [[nodiscard]] std::uint64_t frames_done() const noexcept
    {
        return frames_done_.load(std::memory_order_relaxed);
    }
    /// Brakes all devices and notes the failure; called by the assertion handler.
    void fail() noexcept;

private:
    void rehearse() noexcept;
    [[nodiscard]] FrameOutput run_frame() noexcept;
    void record(const FrameOutput& output) noexcept;
    void choose_budgets(const FrameOutput& output) noexcept;
    void read_devices(std::uint32_t periods) noexcept;
    void write_devices(std::span<const ToolOutput> outputs) noexcept;
    static void mark_stage(void* context, Stage stage) noexcept TACTUS_NONBLOCKING;

    LoopParts parts_;
    RunStatistics& statistics_;
    std::vector<ToolState> states_;
    CycleMeasures measures_;
    MonotonicTime stage_start_{};
    std::atomic<bool> stopped_{false}; ///< Relaxed: it orders nothing else.
    std::atomic<bool> failed_{false};
    std::atomic<bool> done_{false};
    std::atomic<std::uint64_t> frames_done_{0}; ///< Relaxed: shown, nothing more.
};

} // namespace tactus::hrtc
