// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/plot/chart.hpp"

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

/// One HTML file that needs nothing but itself, no script either, and is well-formed XML as well.
/// It is read on a screen, light or dark as the reader has it, on a phone and on paper: drawings
/// shrink with the page, and what is too wide of a table moves inside its own box. All text may be
/// anything. The same calls make the same bytes.
class Page
{
public:
    explicit Page(const std::string& title);

    void heading(const std::string& text);
    void paragraph(const std::string& text);
    /// What it all comes to, where the eye falls.
    void verdict(const std::string& text, bool is_good);
    void table(const Table& table);
    /// Small ones, side by side where there is room.
    void tables(const std::vector<TitledTable>& tables);
    /// Side by side where there is room.
    void drawings(const std::vector<Drawing>& drawings);

    [[nodiscard]] std::string html() const;

private:
    std::string title_;
    std::string body_;
};

/// A table of names and what they come to.
[[nodiscard]] Table facts(const std::vector<std::pair<std::string, std::string>>& pairs);

} // namespace tactus::plot
