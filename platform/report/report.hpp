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

/// The report, schema 1 (docs/report.md). Later versions add keys and never rename any.
[[nodiscard]] nlohmann::ordered_json
make_report(const Options& options, const Controller& controller, const FinishedRun& run);

/// What a person wants to know of a report: names, perhaps the same one twice, and words.
using SummaryFacts = std::vector<std::pair<std::string, std::string>>;
[[nodiscard]] SummaryFacts summary_facts(const nlohmann::ordered_json& report);

/// The same with the times as a few lines.
[[nodiscard]] std::string make_summary(const nlohmann::ordered_json& report);

/// Writes the report whole or not at all; returns why not.
[[nodiscard]] std::optional<Refusal> write_report(const nlohmann::ordered_json& report,
                                                  const std::string& path);

} // namespace tactus::hrtc
