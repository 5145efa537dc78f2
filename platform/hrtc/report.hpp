// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/hrtc/controller.hpp"
#include "platform/hrtc/output_file.hpp"
#include "platform/hrtc/recorder.hpp"
#include "platform/hrtc/run_statistics.hpp"
#include "platform/hrtc/safety_record.hpp"
#include "platform/rt_thread.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace tactus::hrtc
{

/// What a report is made of, once the run has ended.
struct RunRecord
{
    const Controller& controller;
    const RunStatistics& statistics;
    const RtThreadReport& thread;
    const TimerCounts& timer;
    Duration period;
    bool host_was_lost{false};             ///< Some model's host went away during the run.
    std::optional<double> frame_budget_us; ///< None: the budgets were fixed.
    bool calls_were_trapped{false};        ///< System calls of the haptic thread.
    std::optional<RecordingResult> recording;
    const SafetyRecord& safety;
    bool supervisor_fifo{false}; ///< The supervisor had SCHED_FIFO.
};

/// The report, schema 1 (docs/report.md). Later versions add keys and never rename any.
[[nodiscard]] nlohmann::ordered_json make_report(const RunRecord& record);

/// The same for a person: a few lines.
[[nodiscard]] std::string make_summary(const nlohmann::ordered_json& report);

/// Writes the report whole or not at all; returns why not.
[[nodiscard]] std::optional<OutputFileError> write_report(const nlohmann::ordered_json& report,
                                                          const std::string& path);

} // namespace tactus::hrtc
