// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plot/page.hpp"

#include "platform/plot/markup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tactus::plot
{

namespace
{

constexpr const char* kPageStyle =
    ":root { --good: #00704f; --bad: #b34700; --stripe: #f4f4f4; }\n"
    "@media screen and (prefers-color-scheme: dark) {\n"
    "  :root { --good: #4fd3a5; --bad: #ff9a57; --stripe: #232323; }\n"
    "}\n"
    "* { box-sizing: border-box; }\n"
    "body { margin: 0 auto; padding: 1rem; max-width: 80rem; background: var(--paper);\n"
    "  color: var(--ink); font: 1rem/1.45 system-ui, sans-serif; overflow-wrap: anywhere; }\n"
    "h1 { font-size: 1.5rem; margin: 0.5rem 0; }\n"
    "h2 { font-size: 1.2rem; margin: 2rem 0 0.5rem; border-bottom: 1px solid var(--grid); }\n"
    "h3 { font-size: 1rem; margin: 1.2rem 0 0.4rem; }\n"
    "p { margin: 0.4rem 0; max-width: 50rem; }\n"
    ".verdict { font-weight: bold; border-left: 0.4rem solid; padding: 0.3rem 0.7rem; }\n"
    ".good { color: var(--good); }\n"
    ".bad { color: var(--bad); }\n"
    ".scroll { overflow-x: auto; margin: 0.5rem 0; }\n"
    "table { border-collapse: collapse; font-size: 0.875rem; overflow-wrap: normal;\n"
    "  font-variant-numeric: tabular-nums; }\n"
    "th, td { padding: 0.2rem 0.7rem 0.2rem 0; text-align: left; vertical-align: top; }\n"
    "th { font-weight: 600; }\n"
    "th[scope=row] { white-space: nowrap; }\n"
    "thead th { border-bottom: 1px solid var(--ink); vertical-align: bottom; }\n"
    "tbody tr:nth-child(even) { background: var(--stripe); }\n"
    ".number { text-align: right; padding-left: 0.7rem; }\n"
    "td.number { white-space: nowrap; }\n"
    ".drawings { display: grid; gap: 1rem; margin: 0.5rem 0;\n"
    "  grid-template-columns: repeat(auto-fit, minmax(min(100%, 30rem), 1fr)); }\n"
    ".tables { columns: 22rem auto; column-gap: 2rem; }\n"
    ".tables section { break-inside: avoid; padding-top: 0.1rem; }\n"
    "figure { margin: 0; max-width: 44rem; }\n"
    ".plot { display: block; width: 100%; height: auto; }\n"
    "@media screen and (max-width: 40rem) {\n"
    "  th[scope=row] { white-space: normal; min-width: 7.5rem; }\n"
    "  thead th.number { min-width: 3rem; }\n"
    "}\n"
    "@page { margin: 12mm; }\n"
    "@media print {\n"
    "  body { padding: 0; max-width: none; font-size: 10pt; }\n"
    "  .scroll { overflow: visible; }\n"
    "  table { font-size: 7pt; }\n"
    "  th, td { padding-right: 0.3rem; }\n"
    "  th[scope=row] { white-space: normal; }\n"
    "  .number { padding-left: 0.3rem; }\n"
    "  .tables { columns: 14rem auto; }\n"
    "  .drawings { display: block; }\n"
    "  figure { width: 12cm; }\n"
    "  figure, tr, .verdict { break-inside: avoid; }\n"
    "  h1, h2, h3 { break-after: avoid; }\n"
    "}\n";

std::string head_of(const Table& table)
{
    if (std::ranges::all_of(table.columns, &std::string::empty, &Column::name))
    {
        return {};
    }
    std::string head = "<thead><tr>";
    for (const Column& column : table.columns)
    {
        head += fmt::format("<th scope=\"col\"{}>{}</th>",
                            column.is_number ? " class=\"number\"" : "", escaped(column.name));
    }
    return head + "</tr></thead>\n";
}

/// The first cell of a line names it.
std::string line_of(const std::vector<std::string>& cells, const std::vector<Column>& columns)
{
    std::string line = "<tr>";
    for (std::size_t i = 0; i < columns.size(); ++i)
    {
        line += fmt::format("<{0}{1}>{2}</{3}>", i == 0 ? "th scope=\"row\"" : "td",
                            columns[i].is_number ? " class=\"number\"" : "",
                            escaped(i < cells.size() ? cells[i] : ""), i == 0 ? "th" : "td");
    }
    return line + "</tr>\n";
}

} // namespace

Page::Page(const std::string& title) : title_(escaped(title)) {}

void Page::heading(const std::string& text)
{
    body_ += "<h2>" + escaped(text) + "</h2>\n";
}

void Page::paragraph(const std::string& text)
{
    body_ += "<p>" + escaped(text) + "</p>\n";
}

void Page::verdict(const std::string& text, bool is_good)
{
    body_ +=
        fmt::format("<p class=\"verdict {}\">{}</p>\n", is_good ? "good" : "bad", escaped(text));
}

void Page::table(const Table& table)
{
    body_ += "<div class=\"scroll\" tabindex=\"0\"><table>\n" + head_of(table) + "<tbody>\n";
    for (const std::vector<std::string>& line : table.lines)
    {
        body_ += line_of(line, table.columns);
    }
    body_ += "</tbody></table></div>\n";
}

void Page::tables(const std::vector<TitledTable>& tables)
{
    body_ += "<div class=\"tables\">\n";
    for (const auto& [title, small] : tables)
    {
        body_ += "<section>\n<h3>" + escaped(title) + "</h3>\n";
        table(small);
        body_ += "</section>\n";
    }
    body_ += "</div>\n";
}

void Page::drawings(const std::vector<Drawing>& drawings)
{
    if (drawings.empty())
    {
        return;
    }
    body_ += "<div class=\"drawings\">\n";
    for (const Drawing& drawing : drawings)
    {
        body_ += "<figure>\n" + to_svg_element(drawing) + "</figure>\n";
    }
    body_ += "</div>\n";
}

std::string Page::html() const
{
    return fmt::format("<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">"
                       "\n<head>\n<meta charset=\"utf-8\"/>\n<meta name=\"viewport\" "
                       "content=\"width=device-width, initial-scale=1\"/>\n<title>{0}</title>\n"
                       "<style>\n{1}{2}{3}</style>\n</head>\n<body>\n<h1>{0}</h1>\n{4}</body>\n"
                       "</html>\n",
                       title_, drawing_colours(), drawing_style(), kPageStyle, body_);
}

Table facts(const std::vector<std::pair<std::string, std::string>>& pairs)
{
    Table table{{{"", false}, {"", false}}, {}};
    for (const auto& [name, value] : pairs)
    {
        table.lines.push_back({name, value});
    }
    return table;
}

} // namespace tactus::plot
