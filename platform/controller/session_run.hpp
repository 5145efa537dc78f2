// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/messages.hpp"
#include "platform/controller/finished_run.hpp"
#include "platform/controller/run_hooks.hpp"
#include "platform/controller/transport_thread.hpp"
#include "platform/loop/assertion_brake.hpp"
#include "platform/loop/budget_governor.hpp"
#include "platform/loop/edit_mailbox.hpp"
#include "platform/loop/haptic_loop.hpp"
#include "platform/loop/loop_time.hpp"
#include "platform/loop/refinement_state_tap.hpp"
#include "platform/loop/scene_mailbox.hpp"
#include "platform/loop/supervisor.hpp"
#include "platform/loop/telemetry_tap.hpp"
#include "platform/machine/posix/posix_periodic_timer.hpp"
#include "platform/machine/rt_thread.hpp"
#include "platform/machine/time.hpp"
#include "platform/recording/last_inputs.hpp"
#include "rt_core/math/vec3.hpp"
#include "transport/base/refusal.hpp"
#include "transport/log.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::hrtc
{

class Controller;
class Guardian;
class HandTap;
class ProgramScene;
class Recorder;
class ServerTopics;
class TraceFile;
struct Options;
struct SafetyEvent;

/// Parts of one run. All must outlive the run.
struct RunParts
{
    const Options& options;
    Controller& controller;
    ServerTopics* topics{nullptr}; ///< Null without DDS.
    Recorder* recorder{nullptr};   ///< Null without --record.
    TraceFile* trace{nullptr};     ///< Null without --trace.
    Guardian* guardian{nullptr};   ///< Null if no device needs a guardian.
    RunHooks hooks{};
    ProgramScene* program{nullptr}; ///< Null unless a program changes the scene.
    HandTap* hands{nullptr};        ///< Null unless a program looks at its hands.
    ProgramEdits edits{};
};

/// One run of the loop on its real-time thread, with supervisor and transport on threads of their
/// own. In virtual time there is no supervisor, and the loop's thread does all other work between
/// frames. The main thread calls start(), wait() and finish() in this order, each once. The
/// transport thread runs from construction on.
class SessionRun
{
public:
    explicit SessionRun(const RunParts& parts);
    SessionRun(const SessionRun&) = delete;
    SessionRun& operator=(const SessionRun&) = delete;
    ~SessionRun();

    /// Starts supervisor and loop; with Options::is_stepped, no thread. Returns the reason if a
    /// thread can't start; the loop doesn't run then.
    [[nodiscard]] std::optional<Refusal> start();

    /// Runs the next frame, `periods` periods after the last one; only with Options::is_stepped.
    void step(std::uint32_t periods);

    /// Waits for the loop's end and reports its progress to the hooks, which may end the loop
    /// early. `what`: the run's name for the hooks. After a failed assertion this does not return.
    void wait(const std::string& what);

    /// Ends the loop early, once the forces have faded. Any thread.
    void stop() noexcept { loop_.stop(); }
    /// Time of the loop's clock; with Options::is_stepped between frames.
    [[nodiscard]] MonotonicTime now() const noexcept { return time_.clock().now(); }
    /// Waits for the loop, ends all other threads and returns the results.
    [[nodiscard]] FinishedRun finish();

private:
    [[nodiscard]] ServerTopics* connected_topics();
    [[nodiscard]] ProgramScene* connected_program();
    [[nodiscard]] EditMailbox* make_edit_mailbox();
    [[nodiscard]] RefinementStateTap* make_refinement_state();
    [[nodiscard]] LoopParts loop_parts();
    [[nodiscard]] std::optional<Refusal> start_supervisor();
    void run_loop();
    void work_between_frames();
    void watch(const std::string& what);
    void take_events();
    void report_first_places();
    void report_insides(std::span<const Vec3> places_m);
    void report_device(const SafetyEvent& event);
    void report_refused_datagrams();
    void report_guardian();
    void end_after_failure();
    [[nodiscard]] std::string keep_failed_frame();
    void note_topics();

    RunParts parts_;
    Duration period_;
    FinishedRun done_;
    LoopTime time_;
    PosixPeriodicTimer alarm_; ///< Timer of the supervisor.
    std::optional<BudgetGovernor> governor_;
    SceneMailbox mailbox_;
    std::unique_ptr<EditMailbox> edit_mailbox_; ///< Null if no server edits a model.
    TelemetryTap telemetry_;
    /// Tap of the refinement state; none if no viewer gets it.
    std::optional<RefinementStateTap> refinement_state_;
    std::optional<LastInputs> last_inputs_; ///< None with --record.
    TransportRounds transport_;
    std::optional<TransportThread> transport_thread_;
    HapticLoop loop_;
    /// One a tool: true if its device was last logged as lost.
    std::vector<bool> devices_gone_;
    /// Number of refused datagrams at the last log line, one a tool.
    std::vector<std::uint64_t> datagrams_reported_;
    RateLimitedLog device_log_{log_line};
    Supervisor supervisor_;
    std::optional<AssertionBrake> brake_;
    std::optional<RtThread> supervisor_thread_;
    std::optional<RtThread> haptic_thread_;
};

} // namespace tactus::hrtc
