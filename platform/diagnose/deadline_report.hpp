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

/// One run of a deadline test, settled.
struct DeadlinePhase
{
    std::string name;               ///< "alone", "beside load".
    std::vector<std::string> loads; ///< What ran beside it.
    nlohmann::ordered_json report;  ///< make_report().
    LatencyHistogram wake;
    LatencyHistogram cpu;
    LatencyHistogram response;
};

/// The SCHED_FIFO priority and the period that a test ran with.
struct DeadlineSetting
{
    int priority{0};
    Duration period;
};

/// Keys of a run's report, those of the last phase, and besides: `load`, `histograms_us`,
/// `self_check`, `passed`, and under `alone` the first phase's when there are two.
[[nodiscard]] nlohmann::ordered_json make_deadline_report(const SelfCheck& check,
                                                          std::span<const DeadlinePhase> phases);

/// A table for a person, and the verdict.
[[nodiscard]] std::string make_deadline_summary(const SelfCheck& check,
                                                std::span<const DeadlinePhase> phases,
                                                const DeadlineSetting& setting);

/// The histograms as text, all phases side by side.
[[nodiscard]] std::string make_histogram_text(std::span<const DeadlinePhase> phases);

/// Verdict, figures and the histograms as an HTML page.
[[nodiscard]] std::string make_histogram_page(const SelfCheck& check,
                                              std::span<const DeadlinePhase> phases,
                                              const DeadlineSetting& setting,
                                              plot::ChartLibrary library);

/// No overrun, and a self-check that saw all.
[[nodiscard]] bool is_passed(const SelfCheck& check, std::span<const DeadlinePhase> phases);

} // namespace tactus::hrtc
