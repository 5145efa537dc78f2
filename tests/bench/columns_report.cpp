// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Rows as tables of a column for each metric, and those as Markdown.

#include "tests/bench/bench_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
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

plot::Cell cell(const Row& row)
{
    const bool is_count = row.unit.empty();
    const std::string text = number(row.value, is_count);
    return {row.goal ? fmt::format("{} ({})", text, number(*row.goal, is_count)) : text,
            !row.is_met()};
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

    [[nodiscard]] std::vector<plot::Column> columns() const
    {
        std::vector<plot::Column> names{{"model", false}};
        add(names, {"by", false}, {"setting", false});
        return names;
    }
    /// The first cells of a line; rows with the same ones stand in one line.
    [[nodiscard]] std::vector<std::string> of(const Row& row) const
    {
        std::vector<std::string> names{row.test_case +
                                       (row.scene == row.test_case ? "" : " (" + row.scene + ")")};
        add(names, row.by, row.setting);
        return names;
    }

private:
    template <typename T>
    void add(std::vector<T>& list, const T& author, const T& setting) const
    {
        if (has_authors)
        {
            list.push_back(author);
        }
        if (has_settings)
        {
            list.push_back(setting);
        }
    }
};

/// The place of an item in a list, at whose end it is put when it is new.
template <typename T>
std::size_t place_of(const T& item, std::vector<T>& items)
{
    const auto found = std::ranges::find(items, item);
    const auto place = static_cast<std::size_t>(found - items.begin());
    if (found == items.end())
    {
        items.push_back(item);
    }
    return place;
}

plot::Table table_of(const Rows& part)
{
    const LineHead head{
        std::ranges::any_of(part, [](const Row& row) { return !row.by.empty(); }),
        std::ranges::any_of(part, [](const Row& row) { return !row.setting.empty(); })};
    plot::Table table{head.columns(), {}};
    const std::size_t first = table.columns.size();
    std::vector<std::vector<std::string>> heads;
    std::vector<std::string> metrics;
    for (const Row& row : part)
    {
        const std::size_t line = place_of(head.of(row), heads);
        if (line == table.lines.size())
        {
            table.lines.emplace_back(heads[line].begin(), heads[line].end());
        }
        const std::size_t column = first + place_of(column_name(row), metrics);
        std::vector<plot::Cell>& cells = table.lines[line];
        cells.resize(std::max(cells.size(), column + 1));
        cells[column] = cell(row);
    }
    for (const std::string& metric : metrics)
    {
        table.columns.push_back({metric});
    }
    for (std::vector<plot::Cell>& cells : table.lines)
    {
        cells.resize(table.columns.size());
    }
    return table;
}

std::string markdown_line(const std::vector<std::string>& cells)
{
    return fmt::format("| {} |\n", fmt::join(cells, " | "));
}

/// Bold when the goal is missed, which stands in brackets behind.
std::string markdown_cell(const plot::Cell& cell)
{
    const std::size_t end = std::min(cell.text.find(" ("), cell.text.size());
    return cell.is_missed ? "**" + cell.text.substr(0, end) + "**" + cell.text.substr(end)
                          : cell.text;
}

std::string to_markdown(const plot::Table& table)
{
    std::vector<std::string> words;
    std::ranges::transform(table.columns, std::back_inserter(words), &plot::Column::name);
    std::string text = markdown_line(words);
    text += markdown_line(std::vector<std::string>(words.size(), "---"));
    for (const std::vector<plot::Cell>& line : table.lines)
    {
        words.clear();
        std::ranges::transform(line, std::back_inserter(words), markdown_cell);
        text += markdown_line(words);
    }
    return text;
}

} // namespace

std::vector<RowGroup> grouped_by(const Rows& rows, std::string Row::*key)
{
    std::vector<std::string> keys;
    std::vector<RowGroup> groups;
    for (const Row& row : rows)
    {
        const std::size_t place = place_of(row.*key, keys);
        if (place == groups.size())
        {
            groups.push_back({row.*key, {}});
        }
        groups[place].rows.push_back(row);
    }
    return groups;
}

std::vector<plot::TitledTable> column_tables(const Rows& rows)
{
    std::vector<plot::TitledTable> tables;
    for (const auto& [part, of_part] : grouped_by(rows, &Row::part))
    {
        tables.push_back({part, table_of(of_part)});
    }
    return tables;
}

std::string to_columns(const Rows& rows)
{
    std::string text;
    for (const auto& [part, table] : column_tables(rows))
    {
        text += part.empty() ? "" : fmt::format("{}{}:\n\n", text.empty() ? "" : "\n", part);
        text += to_markdown(table);
    }
    const GoalCount count = count_goals(rows);
    return count.goals == 0 ? text
                            : text + fmt::format("\n{} of {} goals met\n", count.met, count.goals);
}

} // namespace tactus::bench
