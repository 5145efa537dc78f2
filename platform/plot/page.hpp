// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/plot/chart.hpp"
#include "platform/plot/relief.hpp"

#include <string>
#include <vector>

namespace tactus::plot
{

/// Head of a column.
struct Column
{
    std::string name;
    bool is_number{true}; ///< Aligned to the right.
};

/// Lines of text in columns.
struct Table
{
    std::vector<Column> columns; ///< Columns; if all names are empty there is no head.
    std::vector<std::vector<std::string>> lines;
};

/// A table with a heading above it.
struct TitledTable
{
    std::string title;
    Table table;
};

/// Builds one self-contained HTML file that is well-formed XML, too. It suits screens, light or
/// dark by the reader's setting, phones and paper: charts shrink with the page, and wide tables
/// scroll inside their box. All texts are escaped. The same calls make the same bytes. Scripts only
/// draw charts: all else works without them.
class Page
{
public:
    /// `library` is inlined once if there are charts. If it is missing, the page says so instead.
    Page(const std::string& title, ChartLibrary library);

    void heading(const std::string& text);
    void paragraph(const std::string& text);
    /// Adds the overall result, prominently.
    void verdict(const std::string& text, bool is_good);
    void table(const Table& table);
    /// Adds small tables, side by side if there is room.
    void tables(const std::vector<TitledTable>& tables);
    /// Adds a relief; no effect if it has neither a path nor a face.
    void relief(const Relief& relief);
    /// Adds charts, side by side if there is room.
    void charts(const std::vector<Chart>& charts);

    [[nodiscard]] std::string html() const;

private:
    [[nodiscard]] std::string scripts() const;

    std::string title_;
    ChartLibrary library_;
    std::string body_;
    bool has_relief_{false};
    std::vector<std::string> charts_; ///< JSON of each chart.
};

/// A table of names and values.
[[nodiscard]] Table facts(const std::vector<std::pair<std::string, std::string>>& pairs);

} // namespace tactus::plot
