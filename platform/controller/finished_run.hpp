// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/controller/recorder.hpp"
#include "platform/controller/trace_file.hpp"
#include "platform/loop/run_statistics.hpp"
#include "platform/loop/safety_record.hpp"
#include "platform/loop/scene_mailbox.hpp"
#include "platform/machine/periodic_timer.hpp"
#include "platform/machine/rt_thread.hpp"
#include "platform/machine/time.hpp"
#include "platform/scene/scene_keeper.hpp"
#include "transport/dds/authority.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/dds/refusals.hpp"
#include "transport/dds/scene_reader.hpp"

#include <cstdint>
#include <ctime>
#include <optional>
#include <string>
#include <vector>

namespace tactus::hrtc
{

/// What is known of a run that has ended.
struct FinishedRun
{
    RunStatistics statistics;
    RtThreadReport thread{};
    bool supervisor_fifo{false};         ///< The supervisor had SCHED_FIFO.
    std::uint32_t supervisor_periods{0}; ///< Of silence, after which it brakes.
    TimerCounts timer{};
    Duration period;
    std::time_t started{0}; ///< Calendar time.
    SafetyRecord safety;
    bool host_was_lost{false}; ///< Some model's host went away during the run.
    /// One a tool: the object inside which it began, by its model's name; empty: none.
    std::vector<std::string> begins_inside{};
    bool has_other_device{false};     ///< It ended: another one came in a tool's device's place.
    std::vector<PoseUse> pose_uses{}; ///< One an object; none from files.
    std::vector<dds::PoseCounts> pose_counts{};    ///< One a model; none with --ignore-poses.
    SceneNewsCounts scene_news{};                  ///< Of a host's scene.
    std::vector<dds::PeerRefusals> refused{};      ///< Of others on the domain.
    std::vector<dds::ServerEvent> server_events{}; ///< None from files.
    std::uint64_t telemetry_sent{0};
    std::uint64_t states_sent{0};
    std::optional<RecordingResult> recording{};
    std::optional<std::string> recording_error{}; ///< Why a wanted recording is not there.
    std::optional<TraceResult> trace{};
    std::optional<std::string> trace_error{}; ///< Likewise.
};

} // namespace tactus::hrtc
