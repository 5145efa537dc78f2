// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/run_statistics.hpp"
#include "platform/loop/safety_log.hpp"
#include "platform/loop/tool_port.hpp"
#include "platform/machine/heartbeat.hpp"
#include "platform/machine/thread_usage.hpp"
#include "platform/machine/time.hpp"
#include "platform/recording/frame_encoder.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/device_record.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/records/object_touch.hpp"
#include "rt_core/records/safety.hpp"
#include "rt_core/records/tool_force.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <thread>
#include <vector>

namespace tactus
{

class BudgetGovernor;
class Clock;
class EditMailbox;
class Frame;
class FrameTap;
class LastInputs;
class PeriodicTimer;
class SceneMailbox;

} // namespace tactus

namespace tactus::hrtc
{

class CutTap;
class HandTap;
class ModelMarks;
class RefinementStateTap;
class TelemetryTap;
class TraceTap;

/// Parts of the loop. All must outlive the loop.
struct LoopParts
{
    Frame* frame{nullptr};
    std::span<const ToolSetup> tools;
    PeriodicTimer* timer{nullptr};
    const Clock* clock{nullptr};
    /// Budgets of every frame. With a governor, `work` is that of the first frame only.
    Budgets budgets;
    BudgetGovernor* governor{nullptr}; ///< Chooses the work budget of later frames; may be null.
    FrameTap* tap{nullptr};            ///< Records every frame; may be null.
    LastInputs* last_inputs{nullptr};  ///< Keeps every frame's device poses; may be null.
    std::uint64_t frames{0};           ///< Number of frames to run.
    /// Virtual time: processor time is not measured, because this thread does other threads' work,
    /// too.
    bool is_virtual{false};
    const ModelMarks* servers_gone{nullptr};       ///< Models whose server is gone; may be null.
    const ModelMarks* starved{nullptr};            ///< Starved models; may be null.
    SceneMailbox* scene_mailbox{nullptr};          ///< Motion of the objects; may be null.
    EditMailbox* edit_mailbox{nullptr};            ///< Edits of the models; may be null.
    TelemetryTap* telemetry{nullptr};              ///< Shows every frame; may be null.
    RefinementStateTap* refinement_state{nullptr}; ///< Shows the refinement state; may be null.
    TraceTap* trace{nullptr};                      ///< Traces every frame's times; may be null.
    HandTap* hands{nullptr};                       ///< Shows the program its hands; may be null.
    CutTap* cuts{nullptr}; ///< Takes the contacts of tools that cut; may be null.
};

/// Work of the haptic thread. Every period it reads the devices, runs the frame, makes its forces
/// safe, writes them and records the measures. Nothing else happens on that thread.
///
/// The loop orders the steps of a period; a ToolPort does those of one tool. The last frames of a
/// run fade the forces, whether the run ends as planned or by stop(). If another thread has braked
/// a device, the loop releases the brake at once. The force then fades in from the part that the
/// device still renders.
class HapticLoop
{
public:
    HapticLoop(const LoopParts& parts, RunStatistics& statistics);

    /// Runs until all frames are done or stop() was called. The timer must have been started.
    /// Allocates nothing.
    void run() noexcept;

    /// The parts of run(), for a caller that decides when a frame runs: begin() once, then step()
    /// for each frame, and rest() once at the end. One thread; the timer must have been started.
    void begin() noexcept;
    /// Waits for the next deadline and runs one frame.
    void step() noexcept;
    /// Waits for the next deadline without a frame. The next frame counts the period as missed.
    void skip_period() noexcept;
    /// Sends zero forces. No frame may follow.
    void rest() noexcept;

    /// Any thread: ends the loop once the forces have faded.
    void stop() noexcept { stopped_.store(true, std::memory_order_relaxed); }
    /// Any thread: true once fail() is done and the devices are braked.
    [[nodiscard]] bool has_failed() const noexcept { return failed_.load(); }
    [[nodiscard]] bool is_done() const noexcept { return done_.load(); }
    [[nodiscard]] std::uint64_t frames_done() const noexcept
    {
        return frames_done_.load(std::memory_order_relaxed);
    }
    /// Ends the loop after a bug; called by the assertion handler of the thread that found it. On
    /// the haptic thread the last forces fade first, using nothing but the timer and the devices'
    /// write; then all devices are braked permanently. On any other thread they are braked at once.
    void fail() noexcept;

    /// Any thread, once has_failed(): true if the haptic thread found the bug; it runs no more
    /// frames.
    [[nodiscard]] bool has_failed_itself() const noexcept { return has_failed_itself_; }
    /// Any thread, once has_failed(): input of the last frame, if the failure came before that
    /// frame was recorded. None if the failure was between frames or on another thread.
    [[nodiscard]] std::optional<GivenFrame> failed_frame() noexcept;

    [[nodiscard]] const Heartbeat& heartbeat() const noexcept { return heartbeat_; }
    /// Any thread: positions of the tools in the first frame with valid positions of all devices.
    /// Empty before.
    [[nodiscard]] std::span<const Vec3> first_places_m() const noexcept;
    /// Log of the tools' state changes. One other thread may take them.
    [[nodiscard]] SafetyLog& safety_log() noexcept { return log_; }

private:
    void wait_for_deadline() noexcept;
    void run_period() noexcept;
    void warm_caches() noexcept;
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
    [[nodiscard]] bool lacks_a_server(const FrameOutput& output) const noexcept;
    void write_devices() noexcept;
    void fade_last_forces() noexcept;
    void note(std::size_t tool, SafetyState state, ForceOff causes) noexcept;
    static void mark_stage(void* context, Stage stage) noexcept TACTUS_NONBLOCKING;

    LoopParts parts_;
    RunStatistics& statistics_;
    std::deque<ToolPort> ports_;    ///< Ports, one a tool; never moved.
    std::vector<ToolState> states_; ///< States copied from the ports, contiguous for the frame.
    std::vector<ToolForce> forces_; ///< Forces copied from the ports, for the statistics.
    /// First positions, one a tool; not written after has_places_ is set.
    std::vector<Vec3> first_places_m_;
    std::vector<double> radii_m_; ///< Tool radii, one a tool.
    /// Device records, one a tool, for displays and recordings.
    std::vector<DeviceRecord> devices_;
    /// Touches found after the last frame, for SceneMailbox::refresh().
    ObjectTouches touches_;
    FrameInput given_;              ///< Input of the present frame, or else of the last.
    bool is_recorded_{true};        ///< False from the start of a frame until it is recorded.
    bool has_failed_itself_{false}; ///< Set before failed_.
    std::uint64_t frame_{0};
    std::uint32_t skipped_periods_{0}; ///< Periods of skip_period() since the last frame.
    std::uint64_t fade_frames_{0};     ///< Length of a fade (kFadeTime_s) in frames.
    std::uint64_t end_;                ///< Number of frames of the run; stop() lowers it.
    std::atomic<std::thread::id> haptic_thread_{};
    Heartbeat heartbeat_;
    SafetyLog log_;
    CycleMeasures measures_;
    MonotonicTime stage_start_{};
    MonotonicTime last_end_{}; ///< End of the last frame.
    ThreadUsage usage_;        ///< Usage of this thread at `last_end_`.
    /// Voluntary switches in the timer's sleeps since `last_end_`.
    std::int64_t timer_switches_{0};
    std::uint64_t allocations_{0}; ///< Allocations of this thread until the last cycle.
    std::atomic<bool> has_places_{false};
    std::atomic<bool> stopped_{false}; ///< Relaxed: it orders nothing else.
    std::atomic<bool> failing_{false}; ///< Set by the first fail(), before the devices are braked.
    std::atomic<bool> failed_{false};
    std::atomic<bool> done_{false};
    std::atomic<std::uint64_t> frames_done_{0}; ///< Relaxed: for display only.
};

} // namespace tactus::hrtc
