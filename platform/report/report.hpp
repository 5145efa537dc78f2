// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "transport/base/refusal.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::hrtc
{

class Controller;
struct FinishedRun;
struct Options;

/// Report of a run, schema 3 (docs/report.md). Later versions add keys and never rename any.
[[nodiscard]] nlohmann::ordered_json
make_report(const Options& options, const Controller& controller, const FinishedRun& run);

/// Summary of a report for a reader: pairs of a name, which may occur twice, and a text.
using SummaryFacts = std::vector<std::pair<std::string, std::string>>;
[[nodiscard]] SummaryFacts summary_facts(const nlohmann::ordered_json& report);

/// Summary in a few lines, with verdict and times.
[[nodiscard]] std::string make_summary(const nlohmann::ordered_json& report);

/// Writes the report as a whole or not at all. Returns the reason if that fails.
[[nodiscard]] std::optional<Refusal> write_report(const nlohmann::ordered_json& report,
                                                  const std::string& path);

} // namespace tactus::hrtc
