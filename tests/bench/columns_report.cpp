// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Rows as tables of Markdown, for the pages.

#include "tests/bench/bench_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace tactus::bench
{

namespace
{

/// Counts whole, everything else with three digits.
std::string number(double value, bool is_count)
{
    if (!std::isfinite(value))
    {
        return "none";
    }
    return is_count || value >= 100.0 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

std::string cell(const Row& row)
{
    const bool is_count = row.unit.empty();
    std::string text = number(row.value, is_count);
    text = row.is_met() ? text : "**" + text + "**";
    return row.goal ? fmt::format("{} ({})", text, number(*row.goal, is_count)) : text;
}

std::string column_name(const Row& row)
{
    return row.unit.empty() ? row.metric : row.metric + ", " + row.unit;
}

/// Which of the first columns a table has beside the model's.
struct LineHead
{
    bool has_authors;
    bool has_settings;

    [[nodiscard]] std::string title() const
    {
        return std::string("model") + (has_authors ? " | by" : "") +
               (has_settings ? " | setting" : "");
    }
    /// The first cells of a line; rows with the same ones stand in one line.
    [[nodiscard]] std::string of(const Row& row) const
    {
        std::string name = row.test_case;
        name += row.scene == row.test_case ? "" : " (" + row.scene + ")";
        return name + (has_authors ? " | " + row.by : "") +
               (has_settings ? " | " + row.setting : "");
    }
    [[nodiscard]] std::size_t width() const
    {
        return std::size_t{1} + (has_authors ? 1 : 0) + (has_settings ? 1 : 0);
    }
};

/// The place of a name in a list, at whose end it is put when it is new.
std::size_t place_of(const std::string& name, std::vector<std::string>& names)
{
    const auto found = std::find(names.begin(), names.end(), name);
    const auto place = static_cast<std::size_t>(found - names.begin());
    if (found == names.end())
    {
        names.push_back(name);
    }
    return place;
}

std::string markdown_line(const std::vector<std::string>& cells)
{
    return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

std::string to_markdown(std::span<const Row> part)
{
    const LineHead head{
        std::ranges::any_of(part, [](const Row& row) { return !row.by.empty(); }),
        std::ranges::any_of(part, [](const Row& row) { return !row.setting.empty(); })};
    std::vector<std::string> columns{head.title()};
    std::vector<std::string> names;
    std::vector<std::vector<std::string>> lines;
    for (const Row& row : part)
    {
        const std::size_t line = place_of(head.of(row), names);
        lines.resize(names.size());
        const std::size_t column = place_of(column_name(row), columns);
        lines[line].resize(std::max(lines[line].size(), column));
        lines[line][column - 1] = cell(row);
    }
    std::string text = markdown_line(columns);
    text += markdown_line(std::vector<std::string>(columns.size() - 1 + head.width(), "---"));
    for (std::size_t line = 0; line < lines.size(); ++line)
    {
        lines[line].resize(columns.size() - 1);
        lines[line].insert(lines[line].begin(), names[line]);
        text += markdown_line(lines[line]);
    }
    return text;
}

} // namespace

std::string to_columns(const Rows& rows)
{
    std::vector<std::string> parts;
    std::vector<Rows> rows_of;
    for (const Row& row : rows)
    {
        const std::size_t part = place_of(row.part, parts);
        rows_of.resize(parts.size());
        rows_of[part].push_back(row);
    }
    std::string text;
    for (std::size_t part = 0; part < parts.size(); ++part)
    {
        text +=
            parts[part].empty() ? "" : fmt::format("{}{}:\n\n", part > 0 ? "\n" : "", parts[part]);
        text += to_markdown(rows_of[part]);
    }
    const GoalCount count = count_goals(rows);
    return count.goals == 0 ? text
                            : text + fmt::format("\n{} of {} goals met\n", count.met, count.goals);
}

} // namespace tactus::bench
