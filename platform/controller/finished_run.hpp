// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/controller/run_results.hpp"
#include "platform/loop/run_statistics.hpp"
#include "platform/loop/safety_log.hpp"
#include "platform/loop/scene_mailbox.hpp"
#include "platform/machine/periodic_timer.hpp"
#include "platform/machine/rt_thread.hpp"
#include "platform/machine/time.hpp"
#include "platform/scene/scene_parts.hpp"
#include "transport/dds/authority.hpp"
#include "transport/dds/edit_reader.hpp"
#include "transport/dds/refusals.hpp"
#include "transport/dds/scene_reader.hpp"

#include <cstdint>
#include <ctime>
#include <optional>
#include <string>
#include <vector>

namespace tactus::hrtc
{

/// Results of a run that has ended.
struct FinishedRun
{
    RunStatistics statistics;
    RtThreadReport thread{};
    bool supervisor_fifo{false};         ///< True if the supervisor had SCHED_FIFO.
    std::uint32_t supervisor_periods{0}; ///< Silent periods before the supervisor brakes.
    TimerCounts timer{};
    Duration period;
    std::time_t started{0}; ///< Calendar time of the start.
    SafetyRecord safety;
    bool server_was_lost{false}; ///< True if a model's server was lost during the run.
    /// Name of the model inside which each tool began, one entry a tool; empty: outside.
    std::vector<std::string> begins_inside{};
    /// True if another device took the place of a tool's device, which ended the run.
    bool has_other_device{false};
    std::vector<PoseUse> pose_uses{}; ///< Use of poses, one entry an object; empty without DDS.
    /// Counts of poses, one entry a model; empty if poses aren't followed.
    std::vector<dds::PoseCounts> pose_counts{};
    /// Counts of edits, one entry a model; empty if no model can be edited.
    std::vector<dds::EditReader::Counts> edit_counts{};
    std::optional<CutCounts> cuts{};               ///< Edit requests of tools; none without --edit.
    SceneNewsCounts scene_news{};                  ///< Counts of the changes of a server's scene.
    std::vector<dds::PeerRefusals> refused{};      ///< Refused messages of other participants.
    std::vector<dds::ServerEvent> server_events{}; ///< Events of the servers; empty for files.
    std::uint64_t telemetry_sent{0};
    std::uint64_t states_sent{0};
    std::optional<RecordingResult> recording{};
    std::optional<std::string> recording_error{}; ///< Reason why a requested recording is missing.
    std::optional<TraceResult> trace{};
    std::optional<std::string> trace_error{}; ///< Reason why a requested trace is missing.
};

} // namespace tactus::hrtc
