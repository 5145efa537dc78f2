// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/bench_report.hpp"

#include "platform/hrtc/machine.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <span>
#include <vector>

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

std::vector<plot::Cell> figure_cells(std::span<const Row> figure)
{
    const Row& first = figure.front();
    const bool has_goal = count_goals(Rows(figure.begin(), figure.end())).goals > 0;
    const std::string judged = has_goal ? verdict(figure) : "";
    const auto goal = [](const Row& row) { return row.goal ? number(*row.goal) : "-"; };
    const auto peer = [](const Row& row) { return row.peer ? number(row.peer_value) : "-"; };
    return {first.test_case,
            figure_of(first),
            joined(figure, [](const Row& row) { return number(row.value); }),
            first.unit,
            has_goal ? joined(figure, goal) : "",
            {judged, judged.starts_with("NOT")},
            first.peer ? *first.peer + " " + joined(figure, peer) : ""};
}

std::string text_line(const std::vector<std::string>& cells)
{
    std::string line = fmt::format("{:<16}{:<22}{:<24}{:<8}{:<22}{:<22}{}", cells[0], cells[1],
                                   cells[2], cells[3], cells[4], cells[5], cells[6]);
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

plot::Table figure_table(const Rows& rows, Figures which)
{
    plot::Table table{{{"case", false},
                       {"figure", false},
                       {"p50 / p99 / max"},
                       {"unit", false},
                       {"goal"},
                       {"", false},
                       {"peer, same run", false}},
                      {}};
    for (std::size_t i = 0; i < rows.size();)
    {
        const std::span<const Row> figure = std::span(rows).subspan(i, figure_length(rows, i));
        if (which == Figures::all || count_goals(Rows(figure.begin(), figure.end())).goals > 0)
        {
            table.lines.push_back(figure_cells(figure));
        }
        i += figure.size();
    }
    return table;
}

bool has_quantiles(const Rows& rows)
{
    for (std::size_t i = 0; i < rows.size(); ++i)
    {
        if (figure_length(rows, i) > 1)
        {
            return true;
        }
    }
    return false;
}

std::string to_goal_table(const Rows& rows)
{
    const plot::Table table = figure_table(rows, Figures::with_goals);
    std::vector<std::string> words;
    std::ranges::transform(table.columns, std::back_inserter(words), &plot::Column::name);
    std::string text = text_line(words);
    for (const std::vector<plot::Cell>& line : table.lines)
    {
        words.clear();
        std::ranges::transform(line, std::back_inserter(words), &plot::Cell::text);
        text += text_line(words);
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

std::string to_json(const Results& results, const RunFacts& facts)
{
    using Json = nlohmann::ordered_json;
    Json list = Json::array();
    for (const Row& row : results.rows)
    {
        list.push_back(to_json(row));
    }
    const hrtc::Machine machine = hrtc::describe_machine();
    Json all{{"schema", 2},
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
             {"options", facts.options},
             {"compiler", __VERSION__},
             {"rows", list}};
    if (!results.failures.empty())
    {
        all["failures"] = results.failures;
    }
    return all.dump(2) + "\n";
}

} // namespace tactus::bench
