// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/hrtc/controller.hpp"
#include "platform/hrtc/host_topics.hpp"
#include "platform/hrtc/options.hpp"
#include "platform/hrtc/recorder.hpp"
#include "platform/hrtc/run_statistics.hpp"
#include "platform/hrtc/safety_record.hpp"
#include "platform/periodic_timer.hpp"
#include "platform/rt_thread.hpp"
#include "transport/dds/dds_client.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::hrtc
{

/// Why there is no run, and the code to leave with.
struct SessionError
{
    std::string text;
    int code{0};
};

/// One that happened at run time.
[[nodiscard]] SessionError failure(std::string text);

/// Says it in one line on stderr; returns the code to leave with.
int leave_with(const SessionError& error);

/// A run that has ended.
struct FinishedRun
{
    RunStatistics statistics;
    RtThreadReport thread;
    bool supervisor_fifo{false}; ///< The supervisor had SCHED_FIFO.
    TimerCounts timer;
    Duration period;
    SafetyRecord safety;
    bool host_was_lost{false};                ///< Some model's host went away during the run.
    std::vector<PoseUse> pose_uses;           ///< One an object; none from files.
    std::vector<dds::PoseCounts> pose_counts; ///< Likewise; none when poses are passed over.
    std::uint64_t telemetry_sent{0};
    std::optional<RecordingResult> recording;
    std::optional<std::string> recording_error; ///< Why a wanted recording is not there.
};

/// The models that the options name and a controller that touches them, for one run.
class Session
{
public:
    /// Tries what the options ask of the machine (probe_realtime()), finds the models, waiting for
    /// those that nobody publishes yet, and assembles the controller.
    [[nodiscard]] static Result<std::unique_ptr<Session>, SessionError>
    open(const Options& options);

    [[nodiscard]] Controller& controller() noexcept { return *controller_; }
    [[nodiscard]] const Controller& controller() const noexcept { return *controller_; }

    /// Runs the loop on its real-time thread with the supervisor, the transport and the recorder
    /// beside it, and waits for its end; SIGINT and SIGTERM end it early, forces fading. Once.
    /// `what` names it for the progress line. When an assertion fails in the run, the forces fade
    /// and the process ends here with exit code 2.
    [[nodiscard]] Result<FinishedRun, SessionError> run(const std::string& what);

private:
    explicit Session(const Options& options) : options_(options) {}

    Options options_;
    std::unique_ptr<dds::DdsClient> client_; ///< Lives as long as the links of its models.
    std::unique_ptr<Controller> controller_;
    std::unique_ptr<HostTopics> topics_; ///< None from files.
};

/// One line on stderr behind the program's name, whatever is in it: file names may hold control
/// characters.
void log_line(std::string line);

/// SIGINT and SIGTERM are noted and end the run that is on; a failed assertion brakes the devices.
void install_handlers();

/// Whether one of the signals has come.
[[nodiscard]] bool was_interrupted() noexcept;

/// Why a run that one of them ended can't be judged.
[[nodiscard]] SessionError interruption();

} // namespace tactus::hrtc
