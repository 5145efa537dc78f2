// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/plot/chart.hpp"
#include "platform/plot/relief.hpp"

#include <string>
#include <vector>

namespace tactus::plot
{

struct Column
{
    std::string name;
    bool is_number{true}; ///< Set against the right.
};

struct Table
{
    std::vector<Column> columns; ///< Without any name there is no head.
    std::vector<std::vector<std::string>> lines;
};

struct TitledTable
{
    std::string title;
    Table table;
};

/// One HTML file that needs nothing but itself and is well-formed XML as well. It is read on a
/// screen, light or dark as the reader has it, on a phone and on paper: charts shrink with the
/// page, and what is too wide of a table moves inside its own box. All text may be anything. The
/// same calls make the same bytes. Scripts draw charts and nothing else: a reader without them has
/// the rest.
class Page
{
public:
    /// `library` is inlined once if there are charts. Where it is missing, the page says so
    /// instead.
    Page(const std::string& title, ChartLibrary library);

    void heading(const std::string& text);
    void paragraph(const std::string& text);
    /// What it all comes to, where the eye falls.
    void verdict(const std::string& text, bool is_good);
    void table(const Table& table);
    /// Small ones, side by side where there is room.
    void tables(const std::vector<TitledTable>& tables);
    /// Nothing of one without a way or a face.
    void relief(const Relief& relief);
    /// Side by side where there is room.
    void charts(const std::vector<Chart>& charts);

    [[nodiscard]] std::string html() const;

private:
    [[nodiscard]] std::string scripts() const;

    std::string title_;
    ChartLibrary library_;
    std::string body_;
    bool has_relief_{false};
    std::vector<std::string> charts_; ///< The JSON of each.
};

/// A table of names and what they come to.
[[nodiscard]] Table facts(const std::vector<std::pair<std::string, std::string>>& pairs);

} // namespace tactus::plot
