// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/self_check.hpp"
#include "platform/machine/latency_histogram.hpp"
#include "platform/plot/chart.hpp"

#include <nlohmann/json.hpp>

#include <span>
#include <string>
#include <vector>

namespace tactus::hrtc
{

/// One run of a deadline test, after its suspected frames were judged.
struct DeadlinePhase
{
    std::string name;               ///< Name: "alone" or "beside load".
    std::vector<std::string> loads; ///< Names of the loads beside the run.
    nlohmann::ordered_json report;  ///< Report of the run, from make_report().
    LatencyHistogram wake;
    LatencyHistogram cpu;
    LatencyHistogram response;
};

/// SCHED_FIFO priority and period of a test.
struct DeadlineSetting
{
    int priority{0};
    Duration period;
};

/// Report of the last phase, with the keys of a run's report. Further keys are `load`,
/// `histograms_us`, `self_check` and `passed`. If there are two phases, `alone` holds the first.
[[nodiscard]] nlohmann::ordered_json make_deadline_report(const SelfCheck& check,
                                                          std::span<const DeadlinePhase> phases);

/// Table and verdict for the terminal.
[[nodiscard]] std::string make_deadline_summary(const SelfCheck& check,
                                                std::span<const DeadlinePhase> phases,
                                                const DeadlineSetting& setting);

/// Histograms as text, all phases side by side.
[[nodiscard]] std::string make_histogram_text(std::span<const DeadlinePhase> phases);

/// HTML page with verdict, figures and histograms.
[[nodiscard]] std::string make_histogram_page(const SelfCheck& check,
                                              std::span<const DeadlinePhase> phases,
                                              const DeadlineSetting& setting,
                                              plot::ChartLibrary library);

/// True if no overrun occurred and the self-check passed.
[[nodiscard]] bool is_passed(const SelfCheck& check, std::span<const DeadlinePhase> phases);

} // namespace tactus::hrtc
