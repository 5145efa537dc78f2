// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/messages.hpp"
#include "platform/choices/run_options.hpp"
#include "platform/controller/controller.hpp"
#include "platform/controller/finished_run.hpp"
#include "platform/controller/guardian.hpp"
#include "platform/controller/host_topics.hpp"
#include "platform/controller/recorder.hpp"
#include "platform/controller/run_hooks.hpp"
#include "platform/controller/trace_file.hpp"
#include "platform/controller/transport_thread.hpp"
#include "platform/loop/assertion_brake.hpp"
#include "platform/loop/budget_governor.hpp"
#include "platform/loop/haptic_loop.hpp"
#include "platform/loop/loop_time.hpp"
#include "platform/loop/refinement_state_tap.hpp"
#include "platform/loop/scene_mailbox.hpp"
#include "platform/loop/supervisor.hpp"
#include "platform/loop/telemetry_tap.hpp"
#include "platform/machine/posix/posix_periodic_timer.hpp"
#include "platform/machine/rt_thread.hpp"
#include "transport/log.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tactus::hrtc
{

/// What one run works with. All of it outlives the run.
struct RunParts
{
    const Options& options;
    Controller& controller;
    HostTopics* topics{nullptr}; ///< None from files.
    Recorder* recorder{nullptr}; ///< None unless --record.
    TraceFile* trace{nullptr};   ///< None unless --trace.
    Guardian* guardian{nullptr}; ///< None unless a device needs one.
    RunHooks hooks{};
};

/// One run of the loop on its real-time thread, the supervisor and the transport beside it; in
/// virtual time nobody has to be supervised, and the loop's thread does all of it in turn. The main
/// thread calls start(), wait() and finish() in this order, each once. The transport thread runs
/// from construction on.
class SessionRun
{
public:
    explicit SessionRun(const RunParts& parts);
    SessionRun(const SessionRun&) = delete;
    SessionRun& operator=(const SessionRun&) = delete;
    ~SessionRun();

    /// Starts supervisor and loop. Returns why that was refused; nothing runs then.
    [[nodiscard]] std::optional<Refusal> start();

    /// Waits for the loop's end and tells how far it is; `what` names the run in these lines. When
    /// the hooks say so the loop ends early. After a failed assertion this does not return.
    void wait(const std::string& what);

    /// Ends all threads.
    [[nodiscard]] FinishedRun finish();

private:
    [[nodiscard]] HostTopics* connected_topics();
    [[nodiscard]] RefinementStateTap* make_front();
    [[nodiscard]] LoopParts loop_parts();
    [[nodiscard]] std::optional<Refusal> start_supervisor();
    void run_loop();
    void work_between_frames();
    void watch(const std::string& what);
    void take_events();
    void tell_of_first_places();
    void tell_of_insides(std::span<const Vec3> places_m);
    void tell_of_device(const SafetyEvent& event);
    void tell_of_strangers();
    void tell_of_guardian();
    void end_after_failure();
    [[nodiscard]] std::string keep_failed_frame();
    void finish_recording();
    void finish_trace();
    void note_topics();

    RunParts parts_;
    Duration period_;
    FinishedRun done_;
    LoopTime time_;
    PosixPeriodicTimer alarm_; ///< The supervisor's.
    std::optional<BudgetGovernor> governor_;
    SceneMailbox queues_;
    TelemetryTap telemetry_;
    std::optional<RefinementStateTap> front_; ///< None with --no-refinement-state.
    std::optional<LastInputs> last_inputs_;   ///< None with --record.
    TransportRounds transport_;
    std::optional<TransportThread> transport_thread_;
    HapticLoop loop_;
    std::vector<bool> devices_gone_;       ///< One a tool, as was told.
    std::vector<std::uint64_t> strangers_; ///< Likewise: datagrams refused at its device's port.
    RateLimitedLog device_log_{log_line};
    Supervisor supervisor_;
    std::optional<AssertionBrake> brake_;
    std::optional<RtThread> supervisor_thread_;
    std::optional<RtThread> haptic_thread_;
};

} // namespace tactus::hrtc
