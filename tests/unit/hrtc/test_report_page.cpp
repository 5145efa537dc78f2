// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/options/options.hpp"
#include "platform/plot/markup.hpp"
#include "platform/report/report.hpp"
#include "rt_core/frame/frame.hpp"
#include "tests/shared/count_of.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

namespace tactus::hrtc::test
{
namespace
{

using Json = nlohmann::ordered_json;
using tactus::test::count_of;

/// Report like make_report()'s, with a different number for each figure.
Json report_of(const std::string& model)
{
    Json report = Json::parse(R"({
        "schema": 1,
        "run": {"version": "1.2.3", "started_utc": "2026-01-02T03:04:05Z", "devices": ["hand"],
                "options": "rate=1000"},
        "frames": 5003, "period_ns": 1000003, "duration_s": 5.003, "times_us": {},
        "answers": {"exact": 4001, "separated": 1002, "within_tolerance": 0, "bounded": 0,
                    "stale": 0, "longest_inexact_run": 23, "width_max_diag": 1.234567e-5},
        "work": {"splits": 29, "merges": 31},
        "budgets": {"frame_us": 500, "at_floor": 0, "work": {"min": 41, "max": 41}},
        "scene": {"objects": 811, "objects_max": 821, "pairs_awake_max": 823,
                  "invisible_wall_frames": 827, "limited": 0,
                  "models": {"known": 829, "resident": 839}},
        "pools": {"pages": {"used_max": 43, "capacity": 47},
                  "faces": {"used_max": 53, "capacity": 59}, "total_bytes": 2097169},
        "cache": {"prediction": "auto", "loads": 61, "evictions": 67},
        "wire": {"bytes_received": 71000, "server_lost": false,
                 "arrival_ms": {"p50": 1.5, "p99": 2.5, "max": 3.5}},
        "servers": {"pinned": 1, "lost": 0, "back": 0, "replaced": 0, "not_followed": 0,
                    "namesake": 0, "events": []},
        "refused": [{"peer": "spm_publish <4>", "id": "00", "identity": 151}],
        "deadline": {"missed": 73, "overrun": 0, "latency_misses": 79, "stopped": 0,
                     "noted": [{"frame": 83, "flags": ["woken_late"], "wake_us": 89.5}]},
        "realtime": {"allocations": 0, "page_faults": 97, "virtual_time": false,
                     "system_calls_trapped": true, "system_calls_in_frame": 0,
                     "system_calls_outside": 101},
        "recording": null, "trace": null, "carving": null, "telemetry": {"sent": 103},
        "force": {"max_n": 1.25, "max_step_n": 0.75, "contact_share": 0.5, "force_share": 0.4375,
                  "data_limited_share": 0.03125},
        "safety": {"supervisor_brakes": 107,
                   "begun": {"software": 1, "disconnect": 0, "stall": 109},
                   "events": [{"time_s": 0.125, "frame": 157, "causes": ["stall"]}]},
        "faults": {"chunk_late": 113},
        "machine": {"kernel": "Linux <6> & more", "processors": 127},
        "models": [{"name": "", "static": false, "diagonal_m": 0.3125, "pieces_refused": 0,
                    "pieces_overdue": 0, "pieces_missing": 0,
                    "pose": {"followed": false, "moves": 131}}],
        "tools": [{"radius_m": 0.002, "begins_inside": null,
                   "torque_max_nm": 0.0625, "stiffness_limit_n_per_m": 3000.5,
                   "least_stiffness_n_per_m": 1500.25,
                   "conditioned": {"stiffness_limited": 137, "damped": 139}}],
        "pairs": [{"tool": 0, "model": "", "answers": {"exact": 149}}]})");
    double first = 1.0;
    for (const char* name :
         {"load", "refine", "refit", "query", "force", "frame", "cpu", "wake", "response"})
    {
        report["times_us"][name] = {{"mean", first},       {"p50", first + 0.1},
                                    {"p90", first + 0.2},  {"p99", first + 0.3},
                                    {"p999", first + 0.4}, {"max", first + 0.5}};
        first += 1.0;
    }
    report["models"][0]["name"] = report["pairs"][0]["model"] = model;
    return report;
}

/// Replacement of the chart library, which is not run here.
plot::ChartLibrary library()
{
    return {"the library's script", "its style", ""};
}

RunStatistics statistics_of(std::size_t frames)
{
    RunStatistics statistics(1, 1, 1, milliseconds(1));
    for (std::size_t i = 0; i < frames; ++i)
    {
        statistics.frame.record(microseconds(10));
        statistics.stages[1].record(microseconds(3));
    }
    return statistics;
}

/// True if some text of the page is this number to its printed digits.
bool has_number(const std::string& page, double number)
{
    for (std::size_t at = page.find('>'); at != std::string::npos; at = page.find('>', at + 1))
    {
        char* end = nullptr;
        const double value = std::strtod(page.c_str() + at + 1, &end);
        const bool is_all = end != page.c_str() + at + 1 && *end == '<';
        if (is_all && std::abs(value - number) <= 1e-5 * std::abs(number))
        {
            return true;
        }
    }
    return false;
}

bool has_text(const std::string& page, const std::string& text)
{
    return page.find(">" + plot::escaped(text) + "<") != std::string::npos;
}

/// Figures of a report that the page lacks.
std::vector<std::string> lacking(const Json& report, const std::string& page)
{
    std::vector<std::string> names;
    const Json flat = report.flatten();
    for (const auto& [name, value] : flat.items())
    {
        const bool is_in_words = name == "/schema" || name == "/frames" || name == "/period_ns" ||
                                 name == "/duration_s" || value.is_null() || value.is_boolean();
        const bool is_there =
            is_in_words || (value.is_number() ? has_number(page, value.get<double>())
                                              : has_text(page, value.get<std::string>()));
        if (!is_there)
        {
            names.push_back(name);
        }
    }
    return names;
}

TEST(ReportPage, holds_every_figure_of_the_report)
{
    const Json report = report_of("bunny");
    const std::string page = make_page(report, statistics_of(5'003), library());
    EXPECT_EQ(lacking(report, page), std::vector<std::string>{});
    EXPECT_TRUE(has_text(page, "Report schema 1, 5003 frames of 1000003 ns, 5.003 s."));
    // Force, bounds, stages over time; histograms of a frame, its stages, waking.
    EXPECT_EQ(count_of(page, "<div class=\"chart\">"), 6U);
    for (const auto& [name, fact] : summary_facts(report))
    {
        EXPECT_TRUE(has_text(page, name) && has_text(page, fact)) << name;
    }
}

TEST(ReportPage, explains_every_answer_time_and_cause)
{
    const Json report = report_of("bunny");
    const std::string page = make_page(report, statistics_of(1), library());
    const auto meaning_of = [](const std::string& name)
    {
        for (const auto& [word, meaning] : report_words())
        {
            const std::string words = std::string(" ") + word + ",";
            if (words.find(" " + name + ",") != std::string::npos)
            {
                return meaning;
            }
        }
        return std::string();
    };
    std::vector<std::string> names(kForceOffNames.begin(), kForceOffNames.end());
    for (const auto& [name, times] : report["times_us"].items())
    {
        names.push_back(name);
    }
    for (const char* name : {"exact", "separated", "bounded", "stale", "overrun", "latency miss"})
    {
        names.emplace_back(name);
    }
    for (const std::string& name : names)
    {
        EXPECT_FALSE(meaning_of(name).empty()) << name;
        EXPECT_TRUE(has_text(page, meaning_of(name))) << name;
    }
}

TEST(ReportPage, a_hostile_name_stays_text)
{
    const std::string name = "</title></td><script>alert('\"')</script>&\x1B[31m";
    const std::string page = make_page(report_of(name), statistics_of(1), library());
    EXPECT_EQ(count_of(page, "</script>"), 3U); // Data, library, drawing code.
    EXPECT_EQ(count_of(page, "alert("), count_of(page, "&lt;script&gt;alert("));
    EXPECT_EQ(count_of(page, "</title>"), 1U);
    EXPECT_NE(page.find(">&lt;/title&gt;&lt;/td&gt;&lt;script&gt;alert(&#39;&quot;&#39;)"
                        "&lt;/script&gt;&amp;\uFFFD[31m<"),
              std::string::npos);
}

/// Data of the charts, as the page's script parses them.
Json charts_of(const std::string& page)
{
    const std::string begin = "id=\"chart-data\">";
    const std::size_t at = page.find(begin) + begin.size();
    return Json::parse(page.substr(at, page.find("</script>", at) - at));
}

TEST(ReportPage, marks_faults_where_they_were)
{
    Json report = report_of("bunny");
    report["period_ns"] = 1'000'000;
    report["safety"]["events"] = Json::array({{{"frame", 3}, {"causes", {"stall"}}},
                                              {{"frame", 4}, {"causes", Json::array()}},
                                              {{"frame", nullptr}, {"causes", {"watchdog"}}}});
    RunStatistics statistics(0, 0, 0, milliseconds(1));
    for (std::uint64_t frame = 0; frame < 7; ++frame)
    {
        CycleMeasures measures;
        measures.allocations = frame == 2 ? 1 : 0;
        measures.frame = microseconds(10 + static_cast<std::int64_t>(frame));
        measures.cycle.wake_lateness = milliseconds(frame == 5 ? 2 : 0);
        measures.lateness_of_end = milliseconds(frame == 5 ? 2 : 0);
        statistics.add(FrameOutput{}, {}, measures);
    }
    const Json charts = charts_of(make_page(report, statistics, library()));
    ASSERT_EQ(charts.size(), 6U);
    for (std::size_t i = 0; i < 3; ++i)
    {
        const Json& marks = charts[i]["marks"];
        ASSERT_EQ(marks.size(), 3U) << marks;
        EXPECT_EQ(marks[0], Json::parse(R"({"name": "overrun", "kind": "fault", "x": [0.002]})"));
        EXPECT_EQ(marks[1],
                  Json::parse(R"({"name": "latency miss", "kind": "warning", "x": [0.005]})"));
        EXPECT_EQ(marks[2], Json::parse(R"({"name": "force off, causes: stall", "kind": "plain",
                                            "x": [0.003]})"));
    }
    EXPECT_EQ(charts[2]["lines"].back()["y"], Json({10.0, 11.0, 12.0, 13.0, 14.0, 15.0, 16.0}));
    EXPECT_EQ(charts[2]["x"].size(), 7U);
}

TEST(ReportPage, is_whole_without_the_chart_library)
{
    const Json report = report_of("bunny");
    const std::string page = make_page(report, statistics_of(5'003),
                                       {.script = {}, .style = {}, .missing = "x <is> gone"});
    EXPECT_EQ(lacking(report, page), std::vector<std::string>{});
    EXPECT_EQ(count_of(page, "3 charts are left out: x &lt;is&gt; gone"), 2U);
    EXPECT_EQ(count_of(page, "<script") + count_of(page, "class=\"chart\""), 0U);
    EXPECT_TRUE(page.ends_with("</html>\n"));
}

TEST(ReportPage, says_what_went_wrong)
{
    Json report = report_of("bunny");
    report["safety"]["begun"]["stall"] = 0; // Only the end of the run.
    report["safety"]["supervisor_brakes"] = 0;
    const auto verdict = [&report](const std::string& kind, const std::string& words)
    {
        const std::string wanted = "<p class=\"verdict " + kind + "\">" + words + "</p>";
        return make_page(report, statistics_of(1), library()).find(wanted) != std::string::npos;
    };
    EXPECT_TRUE(verdict("good", "No overruns of the loop, 79 latency misses; no bounded answers."));
    report["answers"]["bounded"] = 7; // Proven bounds are no fault.
    EXPECT_TRUE(verdict("good", "No overruns of the loop, 79 latency misses; 7 bounded answers."));
    report["deadline"]["overrun"] = 2;
    report["answers"]["stale"] = 5;
    report["wire"]["server_lost"] = true;
    report["safety"]["begun"]["stall"] = 3;
    report["safety"]["supervisor_brakes"] = 1;
    EXPECT_TRUE(verdict("bad",
                        "mesh and scene: the server was lost; 5 frames with a stale answer | "
                        "controller: 2 deadlines missed by an overrun of the loop; force off, "
                        "causes: stall 3; 1 brake by the supervisor | machine: ok."));
    report["deadline"]["overrun"] = 0;
    report["answers"]["stale"] = 0;
    report["wire"]["server_lost"] = false;
    EXPECT_TRUE(verdict("good", "mesh and scene: ok | controller: ok | machine: the loop was woken "
                                "late, and the force faded for a moment 3 times (1 brake by the "
                                "supervisor): &#39;hrtc doctor&#39; lists the causes."));
}

TEST(ReportPage, leaves_out_lists_with_nothing_in_them)
{
    Json report = report_of("bunny");
    report["deadline"]["noted"] = Json::array();
    report["safety"]["events"] = Json::array();
    const std::string page = make_page(report, statistics_of(0), library());
    EXPECT_FALSE(has_text(page, "Noted cycles"));
    EXPECT_FALSE(has_text(page, "Safety events"));
}

TEST(ReportPage, is_what_a_name_in_html_asks_for)
{
    EXPECT_TRUE(is_page_name("run.html"));
    EXPECT_TRUE(is_page_name("/tmp/a.b/run.html"));
    for (const char* other : {"", "run.json", "run.html.json", "run.HTML", "html", "run.htm"})
    {
        EXPECT_FALSE(is_page_name(other)) << other;
    }
}

} // namespace
} // namespace tactus::hrtc::test
