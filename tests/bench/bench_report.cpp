// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "tests/bench/bench_report.hpp"

#include "platform/loop/machine.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <utility>

namespace tactus::bench
{

void add_trial_rows(const test::TrialFigures& figures, const std::string& part, Rows& rows)
{
    Row common;
    common.suite = "stability";
    common.part = part;
    common.test_case = figures.name;
    common.scene = figures.name;
    CaseRows claim(rows, common);
    claim.add("trials", static_cast<double>(figures.trials), "");
    claim.add("worst error", figures.worst, figures.unit, figures.bound);
    claim.add("violations", static_cast<double>(figures.violations), "", 0.0);
}

namespace
{

std::string heading_of(const Row& row)
{
    std::string names = row.test_case;
    for (const std::string& name : {row.part, row.by, row.setting})
    {
        names += name.empty() ? "" : " / " + name;
    }
    return fmt::format("{}  ({}, {} frames, seed {}, hash {:016x})\n", names, row.scene, row.frames,
                       row.seed, row.hash);
}

std::string line_of(const Row& row)
{
    std::string line = fmt::format("  {:<34}{:>12.6g} {:<10}", row.metric, row.value, row.unit);
    if (row.goal)
    {
        line += fmt::format("goal {:.6g} {}  ", *row.goal, row.is_met() ? "met" : "NOT MET");
    }
    if (row.peer)
    {
        line += fmt::format("{} {:.6g}", *row.peer, row.peer_value);
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

std::string to_text(const Rows& rows)
{
    const GoalCount count = count_goals(rows);
    std::string text;
    std::string heading;
    for (const Row& row : rows)
    {
        if (std::string now = heading_of(row); now != heading)
        {
            heading = std::move(now);
            text += heading;
        }
        text += line_of(row);
    }
    return count.goals == 0 ? text
                            : text + fmt::format("{} of {} goals met\n", count.met, count.goals);
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

Row& CaseRows::add(const std::string& metric, double value, const std::string& unit,
                   std::optional<double> goal)
{
    Row& row = rows_.emplace_back(common_);
    row.metric = metric;
    row.value = value;
    row.unit = unit;
    row.goal = goal;
    return row;
}

GoalCount count_goals(const Rows& rows)
{
    GoalCount count;
    for (const Row& row : rows)
    {
        count.goals += row.goal ? 1U : 0U;
        count.met += row.goal && row.is_met() ? 1U : 0U;
    }
    return count;
}

} // namespace tactus::bench
