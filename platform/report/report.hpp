// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/run_options.hpp"
#include "platform/controller/controller.hpp"
#include "platform/loop/run_statistics.hpp"
#include "platform/machine/latency_histogram.hpp"
#include "platform/plot/chart.hpp"
#include "platform/plot/relief.hpp"
#include "rt_core/records/frame_input.hpp"
#include "transport/base/refusal.hpp"
#include "transport/served_model.hpp"

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

/// Lines on the objects and tools before the run: one for each object, or one for many, and one or
/// two for each tool. They warn of objects out of reach and of walls too soft to feel. They name
/// default places and materials if other objects have given ones.
[[nodiscard]] std::string start_lines(const Options& options, const Controller& controller);

/// HTML page of a run's report, with the verdict, all figures and charts. `statistics` must be
/// those of the report. The charts show force, bounds and stage times over the run, and histograms
/// of the times. `relief` shows the paths of the tools; without it the page has no picture.
[[nodiscard]] std::string make_page(const nlohmann::ordered_json& report,
                                    const RunStatistics& statistics, plot::ChartLibrary library,
                                    const plot::Relief& relief = {});

/// Picture of the tools' paths with their forces, and of the base meshes of the nearest objects at
/// their first poses. Call it once the loop has ended.
[[nodiscard]] plot::Relief relief_of(const Controller& controller, const RunStatistics& statistics);

/// Part of the report on deadlines, with single cycles.
[[nodiscard]] nlohmann::ordered_json deadlines_of(const FinishedRun& run);

/// Part of the report on safety: brakes, and times and causes of fades.
[[nodiscard]] nlohmann::ordered_json safety_of(const FinishedRun& run);

/// Part of the report on the servers with authority and their events. Times count from the first
/// safety event; earlier ones are negative.
[[nodiscard]] nlohmann::ordered_json servers_of(const FinishedRun& run);

/// Words of the page that a reader may not know, with their meanings: answers, times, causes of a
/// fade.
[[nodiscard]] SummaryFacts report_words();

/// Percentiles of the histogram in microseconds, as text in the format of HdrHistogram (.hgrm) for
/// its plotter and other readers. Each halving of the share above a percentile has five lines.
[[nodiscard]] std::string hdr_text(const LatencyHistogram& histogram);

/// Writes one file for each of the report's times, named after it, such as frame.hgrm. Returns the
/// refusal of the first file that can't be written.
[[nodiscard]] std::optional<Refusal> write_histograms(const RunStatistics& statistics,
                                                      const std::string& folder);

/// Mean density of the faces of a model's source, at a scale of 1.
struct FaceDensity
{
    double faces{0.0};  ///< Number of all faces.
    double per_m2{0.0}; ///< Faces by the area of the base mesh; 0 if that isn't resident.
};
/// Density of the faces of a model, from its base mesh. This and the functions below: any thread.
[[nodiscard]] FaceDensity face_density(const ServedModel& model);

/// Approximate number of faces that a frame searches if the tool lies flat on a surface of that
/// density: those below its core and within reach around it. 0 for mesh tools.
[[nodiscard]] double faces_under(const ToolSpec& tool, double faces_per_m2);

/// Approximate number of faces for a tool that lies on a model.
struct Footprint
{
    double faces{0.0}; ///< Faces that a frame searches.
    /// Faces in the pools beside the base mesh, so that the searched ones are exact.
    double kept{0.0};
};

/// Footprint of the tool on an object of this scale; 0 for mesh tools and a density of 0.
[[nodiscard]] Footprint footprint_of(const ToolSpec& tool, const FaceDensity& density,
                                     double scale);

} // namespace tactus::hrtc
