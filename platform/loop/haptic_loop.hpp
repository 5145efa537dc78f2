// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/budget_governor.hpp"
#include "platform/loop/front_tap.hpp"
#include "platform/loop/model_marks.hpp"
#include "platform/loop/pose_door.hpp"
#include "platform/loop/run_statistics.hpp"
#include "platform/loop/safety_log.hpp"
#include "platform/loop/telemetry_tap.hpp"
#include "platform/loop/tool_port.hpp"
#include "platform/loop/trace_tap.hpp"
#include "platform/machine/clock.hpp"
#include "platform/machine/heartbeat.hpp"
#include "platform/machine/periodic_timer.hpp"
#include "platform/recording/frame_tap.hpp"
#include "platform/recording/last_inputs.hpp"
#include "rt_core/frame/frame.hpp"

#include <atomic>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <thread>
#include <vector>

namespace tactus::hrtc
{

/// What the loop works on. All of it outlives the loop.
struct LoopParts
{
    Frame* frame{nullptr};
    std::span<const ToolSetup> tools;
    PeriodicTimer* timer{nullptr};
    const Clock* clock{nullptr};
    Budgets budgets;                       ///< Of every frame; the first one's work.
    BudgetGovernor* governor{nullptr};     ///< Chooses the others' work; may be none.
    FrameTap* tap{nullptr};                ///< Takes every frame for a recording; may be none.
    LastInputs* last_inputs{nullptr};      ///< Takes every frame's hands; may be none.
    std::uint64_t frames{0};               ///< How many to run.
    bool is_virtual{false};                ///< No time is measured: others work on the thread, too.
    const ModelMarks* hosts_gone{nullptr}; ///< May be none.
    const ModelMarks* starved{nullptr};    ///< Likewise.
    PoseDoor* pose_door{nullptr};          ///< How the objects move; may be none.
    TelemetryTap* telemetry{nullptr};      ///< Shows every frame; may be none.
    FrontTap* front{nullptr};              ///< Shows what is refined; may be none.
    TraceTap* trace{nullptr};              ///< Takes every frame's times; may be none.
};

/// The haptic thread's work: every period read the devices, run the frame, see that its forces are
/// safe, write them, keep the measures. Nothing else happens on that thread.
///
/// The loop orders the period; what happens at one tool is its ToolPort's. The last frames of a run
/// fade the forces, whether the run ends as planned or by stop(). A device that somebody has braked
/// is released at once and its force fades in from zero.
class HapticLoop
{
public:
    HapticLoop(const LoopParts& parts, RunStatistics& statistics);

    /// Runs until all frames are done or stop() was called. The timer has been started. Allocates
    /// nothing.
    void run() noexcept;

    /// Any thread: ends the loop once the forces have faded.
    void stop() noexcept { stopped_.store(true, std::memory_order_relaxed); }
    /// Any thread: whether fail() has done its work: the devices are braked.
    [[nodiscard]] bool has_failed() const noexcept { return failed_.load(); }
    [[nodiscard]] bool is_done() const noexcept { return done_.load(); }
    [[nodiscard]] std::uint64_t frames_done() const noexcept
    {
        return frames_done_.load(std::memory_order_relaxed);
    }
    /// Ends the loop for a bug; called by the assertion handler of the thread that found it. On the
    /// haptic thread the last forces fade first, with nothing but the timer and the devices' write;
    /// then, and on any other thread at once, all devices are braked for good.
    void fail() noexcept;

    /// Any thread, once has_failed(): whether the haptic thread found the bug, and works no more.
    [[nodiscard]] bool has_failed_itself() const noexcept { return has_failed_itself_; }
    /// Likewise: what the frame was given in which it failed, or with whose forces; none where it
    /// was between frames.
    [[nodiscard]] std::optional<GivenFrame> failed_frame() noexcept;

    /// What the supervisor watches.
    [[nodiscard]] const Heartbeat& heartbeat() const noexcept { return heartbeat_; }
    /// Any thread: where the tools were in the first frame in which all devices told it. None
    /// before.
    [[nodiscard]] std::span<const Vec3> first_places_m() const noexcept;
    /// State changes of the tools; one other thread may take them.
    [[nodiscard]] SafetyLog& safety_log() noexcept { return log_; }

private:
    void wait_for_deadline() noexcept;
    void run_period() noexcept;
    void rehearse() noexcept;
    [[nodiscard]] FrameOutput run_frame(const FrameInput& input) noexcept;
    [[nodiscard]] ThreadUsage thread_usage() const noexcept;
    [[nodiscard]] Duration cpu_time() const noexcept;
    void measure_thread(const ThreadUsage& now) noexcept;
    void record(const FrameInput& input, const FrameOutput& output) noexcept;
    void trace(const FrameOutput& output, MonotonicTime start) noexcept;
    void choose_budgets(const FrameOutput& output) noexcept;
    [[nodiscard]] bool has_to_end() noexcept;
    void read_devices() noexcept;
    void note_first_places() noexcept;
    [[nodiscard]] FrameInput read_scene(MonotonicTime now) noexcept;
    void show(const FrameOutput& output, MonotonicTime start) noexcept;
    void make_safe(const FrameOutput& output) noexcept;
    [[nodiscard]] static bool touches_old_pose(std::uint32_t tool,
                                               const FrameOutput& output) noexcept;
    [[nodiscard]] bool may_touch(const PairOutput& pair, const FrameOutput& output) const noexcept;
    [[nodiscard]] bool meets_what_outruns(std::uint32_t tool) const noexcept;
    [[nodiscard]] bool starves(std::uint32_t tool, const FrameOutput& output) const noexcept;
    [[nodiscard]] double damping_touched(std::uint32_t tool,
                                         const FrameOutput& output) const noexcept;
    [[nodiscard]] ForceOff causes_for_all(const FrameOutput& output) const noexcept;
    [[nodiscard]] bool lacks_a_host(const FrameOutput& output) const noexcept;
    void write_devices() noexcept;
    void fade_last_forces() noexcept;
    void note(std::size_t tool, SafetyState state, ForceOff causes) noexcept;
    static void mark_stage(void* context, Stage stage) noexcept TACTUS_NONBLOCKING;

    LoopParts parts_;
    RunStatistics& statistics_;
    std::deque<ToolPort> ports_;        ///< One a tool; they are never moved.
    std::vector<ToolState> states_;     ///< Copied from the ports, in one piece for the frame.
    std::vector<ToolForce> forces_;     ///< Likewise, for those who keep figures.
    std::vector<Vec3> first_places_m_;  ///< One a tool; written before has_places_ alone.
    std::vector<double> radii_m_;       ///< One a tool.
    std::vector<DeviceRecord> devices_; ///< Likewise, for those who show or record.
    ObjectTouches touches_;             ///< What tools may touch soon, after the last frame.
    FrameInput given_;                  ///< To the frame that runs, or ran last.
    bool is_recorded_{true};            ///< That one.
    bool has_failed_itself_{false};     ///< Before failed_ is set.
    std::uint64_t frame_{0};
    std::uint64_t fade_frames_{0}; ///< That the last forces of a run take.
    std::uint64_t end_;            ///< Frame that is not run any more.
    std::atomic<std::thread::id> haptic_thread_{};
    Heartbeat heartbeat_;
    SafetyLog log_;
    CycleMeasures measures_;
    MonotonicTime stage_start_{};
    MonotonicTime last_end_{};       ///< Of the last frame.
    ThreadUsage usage_;              ///< Of this thread at that time.
    std::int64_t timer_switches_{0}; ///< Voluntary ones in the timer's sleeps since then.
    std::uint64_t allocations_{0};   ///< Likewise.
    std::atomic<bool> has_places_{false};
    std::atomic<bool> stopped_{false}; ///< Relaxed: it orders nothing else.
    std::atomic<bool> failing_{false}; ///< Set by the first that fails.
    std::atomic<bool> failed_{false};
    std::atomic<bool> done_{false};
    std::atomic<std::uint64_t> frames_done_{0}; ///< Relaxed: shown, nothing more.
};

} // namespace tactus::hrtc
