// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "platform/plot/page.hpp"
#include "platform/report/latency_chart.hpp"
#include "platform/report/report.hpp"
#include "platform/report/verdict.hpp"
#include "transport/base/number_form.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <utility>

namespace tactus::hrtc
{

namespace
{

using Json = nlohmann::ordered_json;

/// Largest number of model names in the title; with more models the title gives their number.
constexpr std::size_t kNamesInTitle = 4;

std::string text_of(const Json& value)
{
    switch (value.type())
    {
    case Json::value_t::null:
        return "none";
    case Json::value_t::boolean:
        return value.get<bool>() ? "yes" : "no";
    case Json::value_t::string:
        return value.get<std::string>();
    case Json::value_t::number_float:
        return fmt::format("{:.6g}", value.get<double>());
    case Json::value_t::array:
    {
        std::string text;
        for (const Json& entry : value)
        {
            text += (text.empty() ? "" : ", ") + text_of(entry);
        }
        return text;
    }
    default:
        return value.dump();
    }
}

struct Figure
{
    std::string name;
    std::string text;
    bool is_number;
};

/// Adds all values inside `object` as figures named "outer.inner". Lists of objects are left out;
/// they become tables.
void flatten(const Json& object, const std::string& before, std::vector<Figure>& figures)
{
    for (const auto& [key, value] : object.items())
    {
        const bool is_table = value.is_array() && !value.empty() && value.front().is_object();
        if (value.is_object())
        {
            flatten(value, before + key + ".", figures);
        }
        else if (!is_table)
        {
            figures.push_back({before + key, text_of(value), value.is_number()});
        }
    }
}

std::vector<Figure> figures_of(const Json& object)
{
    std::vector<Figure> figures;
    flatten(object, "", figures);
    return figures;
}

plot::Table facts_of(const Json& object)
{
    SummaryFacts facts;
    for (const Figure& figure : figures_of(object))
    {
        facts.emplace_back(figure.name, figure.text);
    }
    return plot::facts(facts);
}

/// Table with a line for each entry of a list of similar entries.
plot::Table table_of(const Json& list)
{
    plot::Table table;
    for (const Json& entry : list)
    {
        auto& line = table.lines.emplace_back();
        for (const Figure& figure : figures_of(entry))
        {
            line.emplace_back(figure.text);
            if (table.lines.size() == 1)
            {
                table.columns.push_back({figure.name, figure.is_number});
            }
        }
    }
    return table;
}

/// Table with a column for each entry, for entries of many figures.
plot::Table columns_of(const Json& list)
{
    plot::Table table{{{"", false}}, {}};
    for (const Json& entry : list)
    {
        const std::vector<Figure> figures = figures_of(entry);
        table.columns.push_back({fmt::format("{}", table.columns.size() - 1), false});
        table.lines.resize(figures.size());
        for (std::size_t i = 0; i < figures.size(); ++i)
        {
            if (table.lines[i].empty())
            {
                table.lines[i].emplace_back(figures[i].name);
            }
            table.lines[i].emplace_back(figures[i].text);
        }
    }
    return table;
}

plot::Table times_of(const Json& all_times)
{
    plot::Table table{{{"us", false}}, {}};
    for (const auto& [name, times] : all_times.items())
    {
        std::vector<std::string> line{name};
        for (const auto& [quantile, time] : times.items())
        {
            line.emplace_back(fmt::format("{:.1f}", time.get<double>()));
            if (table.lines.empty())
            {
                table.columns.push_back({quantile});
            }
        }
        table.lines.push_back(std::move(line));
    }
    return table;
}

void add_verdict(const Json& report, plot::Page& page)
{
    const std::vector<Complaint> complaints = complaints_of(report);
    if (!complaints.empty())
    {
        page.verdict(verdict_text(complaints) + ".", is_machine_alone(complaints));
        return;
    }
    const auto brackets = report["answers"]["bounded"].get<std::uint64_t>();
    page.verdict(
        fmt::format("No overruns of the loop, {}; {}.",
                    counted(report["deadline"]["latency_misses"].get<std::uint64_t>(),
                            "latency miss", "latency misses"),
                    brackets == 0 ? "no bounded answers" : counted(brackets, "bounded answer")),
        true);
}

/// Marks of missed deadlines and of fades, except that at the end of the run.
std::vector<plot::Mark> marks_of(const Json& report, const RunStatistics& statistics)
{
    const double period_s = report["period_ns"].get<double>() * 1e-9;
    std::vector<plot::Mark> marks;
    for (const NotedCycle& cycle : statistics.deadlines.noted())
    {
        const double time_s = static_cast<double>(cycle.frame) * period_s;
        if (has_any(cycle.flags, kOverruns))
        {
            marks.push_back({time_s, "overrun", plot::MarkKind::fault});
        }
        else if (has_any(cycle.flags, CycleFlag::missed))
        {
            marks.push_back(
                {time_s,
                 has_any(cycle.flags, CycleFlag::stopped) ? "stopped from outside" : "latency miss",
                 plot::MarkKind::warning});
        }
    }
    for (const Json& event : report["safety"]["events"])
    {
        const Json& frame = event["frame"]; // Null for events of the supervisor.
        const bool is_end = event["causes"] == Json{"software"};
        if (frame.is_number() && !event["causes"].empty() && !is_end)
        {
            marks.push_back({frame.get<double>() * period_s,
                             fmt::format("force off, causes: {}", text_of(event["causes"])),
                             plot::MarkKind::plain});
        }
    }
    return marks;
}

/// Charts of force, bounds and, if `has_times`, stage times over the run.
std::vector<plot::Chart> series_of(const Json& report, const RunStatistics& statistics,
                                   bool has_times)
{
    const std::vector<SeriesPoint> points = statistics.series.points();
    const double step_s =
        static_cast<double>(statistics.series.stride()) * report["period_ns"].get<double>() * 1e-9;
    const std::vector<plot::Mark> marks = marks_of(report, statistics);
    const auto chart = [&](const char* title, const char* unit)
    {
        plot::Chart made{.title = title,
                         .x_label = "s",
                         .y_label = unit,
                         .kind = plot::Chart::Kind::series,
                         .x = {},
                         .lines = {},
                         .marks = marks};
        for (std::size_t i = 0; i < points.size(); ++i)
        {
            made.x.push_back(static_cast<double>(i) * step_s);
        }
        return made;
    };
    const auto line = [&points](const char* name, const auto& value_of)
    {
        plot::Line made{name, {}};
        for (const SeriesPoint& point : points)
        {
            made.y.push_back(static_cast<double>(value_of(point)));
        }
        return made;
    };
    std::vector<plot::Chart> charts{chart("Force on the device", "N"),
                                    chart("Widest bounds of bounded or stale answers", "mm"),
                                    chart("Times of the stages", "us")};
    charts[0].lines = {line("force", [](const SeriesPoint& point) { return point.force_n; })};
    charts[1].lines = {
        line("bounded", [](const SeriesPoint& point) { return 1e3F * point.width_m; })};
    if (!has_times)
    {
        charts.pop_back();
        return charts;
    }
    for (std::size_t stage = 0; stage < kStages; ++stage)
    {
        charts[2].lines.push_back(line(kStageNames.at(stage), [stage](const SeriesPoint& point)
                                       { return point.stage_us.at(stage); }));
    }
    charts[2].lines.push_back(
        line("frame", [](const SeriesPoint& point) { return point.frame_us; }));
    return charts;
}

void add_times(const Json& report, const RunStatistics& statistics, plot::Page& page)
{
    page.heading("Course of the run");
    page.paragraph(fmt::format("Each point shows the worst of {}.",
                               counted(statistics.series.stride(), "neighbouring frame")));
    const bool has_times = !report["realtime"]["virtual_time"].get<bool>();
    page.charts(series_of(report, statistics, has_times));
    if (!has_times)
    {
        return; // Virtual time has no stage times.
    }
    page.heading("Times");
    page.table(times_of(report["times_us"]));
    const Duration period{report["period_ns"].get<std::int64_t>()};
    NamedHistograms stages;
    for (std::size_t stage = 0; stage < kStages; ++stage)
    {
        stages.emplace_back(kStageNames.at(stage), &statistics.stages.at(stage));
    }
    const LatencyHistogram response = statistics.deadlines.response();
    page.charts(
        {latency_chart(
             "Time of a frame", "frames",
             {{"frame, device included", &statistics.frame}, {"processor time", &statistics.cpu}},
             period),
         latency_chart("Stages of a frame", "frames", stages, period),
         latency_chart("Wake-up latency and delay of the force", "frames",
                       {{"wake-up latency", &statistics.wake}, {"deadline to force", &response}},
                       period)});
}

/// Adds a list in a section of its own, unless it is empty.
void add_list(const char* heading, const Json& list, plot::Table (*to_table)(const Json& list),
              plot::Page& page)
{
    if (!list.empty())
    {
        page.heading(heading);
        page.table(to_table(list));
    }
}

std::string title_of(const Json& report)
{
    std::vector<std::string> names;
    for (const Json& model : report["models"])
    {
        names.push_back(model["name"].get<std::string>());
    }
    return names.size() > kNamesInTitle ? fmt::format("hrtc: {} models", names.size())
                                        : fmt::format("hrtc: {}", fmt::join(names, ", "));
}

} // namespace

std::string make_page(const Json& report, const RunStatistics& statistics,
                      plot::ChartLibrary library, const plot::Relief& relief)
{
    plot::Page page(title_of(report), std::move(library));
    add_verdict(report, page);
    page.table(plot::facts(summary_facts(report)));
    page.relief(relief);
    add_times(report, statistics, page);
    std::vector<plot::TitledTable> sections;
    for (const auto& [key, title] :
         {std::pair("run", "Run"), std::pair("answers", "Answers, in frames"),
          std::pair("scene", "Scene"), std::pair("cache", "Cache"), std::pair("wire", "Wire"),
          std::pair("deadline", "Deadlines"), std::pair("realtime", "Real-time loop"),
          std::pair("work", "Work"), std::pair("pools", "Pools"), std::pair("budgets", "Budgets"),
          std::pair("force", "Force"), std::pair("safety", "Safety"),
          std::pair("faults", "Frames with a fault"), std::pair("recording", "Recording"),
          std::pair("trace", "Trace"), std::pair("telemetry", "Telemetry"),
          std::pair("machine", "Machine")})
    {
        if (!report[key].is_null())
        {
            sections.push_back({title, facts_of(report[key])});
        }
    }
    page.heading("All figures");
    page.tables(sections);
    add_list("Models", report["models"], columns_of, page);
    add_list("Tools", report["tools"], columns_of, page);
    add_list("Pairs of tool and model", report["pairs"], table_of, page);
    add_list("Messages refused from others on the domain", report["refused"], columns_of, page);
    add_list("Safety events", report["safety"]["events"], table_of, page);
    add_list("Noted cycles", report["deadline"]["noted"], table_of, page);
    page.heading("Words");
    page.table(plot::facts(report_words()));
    page.paragraph(fmt::format("Report schema {}, {} frames of {} ns, {} s.",
                               report["schema"].get<int>(), report["frames"].get<std::uint64_t>(),
                               report["period_ns"].get<std::int64_t>(),
                               text_of(report["duration_s"])));
    return page.html();
}

} // namespace tactus::hrtc
