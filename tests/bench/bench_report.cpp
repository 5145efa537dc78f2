// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/bench_report.hpp"

#include "platform/hrtc/machine.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <span>

namespace tactus::bench
{

namespace
{

/// "warm" of "warm.p99"; a metric without a quantile is its own figure.
std::string figure_of(const Row& row)
{
    const std::size_t dot = row.metric.rfind('.');
    const std::string tail = dot == std::string::npos ? "" : row.metric.substr(dot + 1);
    return tail == "p50" || tail == "p99" || tail == "max" ? row.metric.substr(0, dot) : row.metric;
}

/// How many rows from `first` on are quantiles of the same figure.
std::size_t figure_length(const Rows& rows, std::size_t first)
{
    std::size_t end = first + 1;
    while (end < rows.size() && rows[end].test_case == rows[first].test_case &&
           rows[end].scene == rows[first].scene && figure_of(rows[end]) == figure_of(rows[first]))
    {
        ++end;
    }
    return end - first;
}

std::string number(double value)
{
    return value < 100.0 ? fmt::format("{:.2f}", value) : fmt::format("{:.0f}", value);
}

template <typename Text>
std::string joined(std::span<const Row> figure, const Text& text)
{
    std::string line;
    for (const Row& row : figure)
    {
        line += (line.empty() ? "" : " / ") + text(row);
    }
    return line;
}

std::string verdict(std::span<const Row> figure)
{
    std::string missed;
    for (const Row& row : figure)
    {
        if (!row.is_met())
        {
            const std::string quantile = row.metric.substr(figure_of(row).size());
            missed += quantile.empty() ? "" : " " + quantile.substr(1);
            missed = missed.empty() ? " " : missed;
        }
    }
    return missed.empty() ? "met" : missed == " " ? "NOT MET" : "NOT MET:" + missed;
}

std::string goal_line(std::span<const Row> figure)
{
    const Row& first = figure.front();
    std::string line = fmt::format(
        "{:<16}{:<22}{:<24}{:<8}{:<20}{:<22}", first.test_case, figure_of(first),
        joined(figure, [](const Row& row) { return number(row.value); }), first.unit,
        joined(figure, [](const Row& row) { return row.goal ? number(*row.goal) : "-"; }),
        verdict(figure));
    if (first.peer)
    {
        line +=
            *first.peer + " " +
            joined(figure, [](const Row& row) { return row.peer ? number(row.peer_value) : "-"; });
    }
    line.erase(line.find_last_not_of(' ') + 1);
    return line + '\n';
}

std::string detail_line(const Row& row)
{
    std::string line = fmt::format("  {:<28}{:>12.3f} {:<8}", row.metric, row.value, row.unit);
    if (row.goal)
    {
        line += fmt::format("goal {:.3f} {}  ", *row.goal, row.is_met() ? "met" : "NOT MET");
    }
    if (row.peer)
    {
        line += fmt::format("{} {:.3f}", *row.peer, row.peer_value);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    return line + '\n';
}

nlohmann::ordered_json to_json(const Row& row)
{
    nlohmann::ordered_json entry{{"suite", row.suite}, {"case", row.test_case}};
    if (!row.part.empty())
    {
        entry["part"] = row.part;
    }
    if (!row.by.empty())
    {
        entry["by"] = row.by;
    }
    if (!row.setting.empty())
    {
        entry["setting"] = row.setting;
    }
    entry["metric"] = row.metric;
    entry["value"] = row.value;
    entry["unit"] = row.unit;
    if (row.goal)
    {
        entry["goal"] = *row.goal;
        entry["met"] = row.is_met();
    }
    if (row.peer)
    {
        entry["peer"] = *row.peer;
        entry["peer_value"] = row.peer_value;
    }
    entry["scene"] = row.scene;
    entry["seed"] = row.seed;
    entry["frames"] = row.frames;
    entry["hash"] = fmt::format("{:016x}", row.hash);
    return entry;
}

} // namespace

std::string to_goal_table(const Rows& rows)
{
    std::string text = fmt::format("{:<16}{:<22}{:<24}{:<8}{:<20}{:<22}{}\n", "case", "figure",
                                   "p50 / p99 / max", "unit", "goal", "", "peer, same run");
    for (std::size_t i = 0; i < rows.size();)
    {
        const std::span<const Row> figure = std::span(rows).subspan(i, figure_length(rows, i));
        if (count_goals(Rows(figure.begin(), figure.end())).goals > 0)
        {
            text += goal_line(figure);
        }
        i += figure.size();
    }
    const GoalCount count = count_goals(rows);
    return text + fmt::format("{} of {} goals met\n", count.met, count.goals);
}

std::string to_table(const Rows& rows)
{
    std::string text;
    std::string heading;
    for (const Row& row : rows)
    {
        std::string now = fmt::format("{} / {}", row.scene, row.test_case);
        now += row.part.empty() ? "" : " / " + row.part;
        now += row.by.empty() ? "" : " / " + row.by;
        now += row.setting.empty() ? "" : " / " + row.setting;
        if (now != heading)
        {
            heading = now;
            text += fmt::format("{}  ({} frames, seed {}, hash {:016x})\n", now, row.frames,
                                row.seed, row.hash);
        }
        text += detail_line(row);
    }
    return text;
}

std::string to_json(const Rows& rows, const RunFacts& facts)
{
    using Json = nlohmann::ordered_json;
    Json list = Json::array();
    for (const Row& row : rows)
    {
        list.push_back(to_json(row));
    }
    const hrtc::Machine machine = hrtc::describe_machine();
    const Json all{{"schema", 2},
                   {"commit", TACTUS_COMMIT},
                   {"machine",
                    {{"kernel", machine.kernel},
                     {"preemption", machine.preemption},
                     {"processor", machine.processor},
                     {"processors", machine.processors},
                     {"load_average", machine.load_average},
                     {"date_utc", machine.date_utc}}},
                   {"core", facts.core},
                   {"quick", facts.quick},
                   {"compiler", __VERSION__},
                   {"rows", list}};
    return all.dump(2) + "\n";
}

} // namespace tactus::bench
