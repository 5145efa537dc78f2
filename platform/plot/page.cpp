// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plot/page.hpp"

#include "platform/plot/markup.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>
#include <string_view>
#include <utility>

namespace tactus::plot
{

namespace
{

constexpr const char* kPageStyle =
    ":root { --ink: #222; --grid: #d8d8d8; --paper: #fff;\n"
    "  --good: #00704f; --bad: #b34700; --stripe: #f4f4f4;\n"
    "  --plain: #6b6b6b; --warning: #8f5a00; --fault: #c4161c; }\n"
    "@media screen { :root { color-scheme: light dark; } }\n"
    "@media screen and (prefers-color-scheme: dark) {\n"
    "  :root { --ink: #e8e8e8; --grid: #444; --paper: #181818;\n"
    "    --good: #4fd3a5; --bad: #ff9a57; --stripe: #232323;\n"
    "    --plain: #a0a0a0; --warning: #ffb84d; --fault: #ff6b6b; }\n"
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
    ".charts { display: grid; gap: 1rem; margin: 0.5rem 0;\n"
    "  grid-template-columns: repeat(auto-fit, minmax(min(100%, 30rem), 1fr)); }\n"
    ".tables { columns: 22rem auto; column-gap: 2rem; }\n"
    ".tables section { break-inside: avoid; padding-top: 0.1rem; }\n"
    ".charts figure:last-child:nth-child(odd) { grid-column: 1 / -1; }\n"
    "figure { margin: 0; min-width: 0; }\n"
    "figcaption { font-weight: 600; }\n"
    ".legend, .marks { font-size: 0.8rem; min-height: 1.2em; }\n"
    ".chart { width: 100%; height: 17rem; }\n"
    ".dygraph-label, .dygraph-axis-label { color: var(--ink); font-size: 0.8rem; }\n"
    ".note { font-size: 0.875rem; }\n"
    "@media screen and (max-width: 64rem) {\n"
    "  th, td { padding-right: 0.25rem; overflow-wrap: anywhere; }\n"
    "  th[scope=row] { white-space: normal; min-width: 4.7rem; }\n"
    "  .number { padding-left: 0.25rem; }\n"
    "}\n"
    "@media screen and (max-width: 40rem) { table { font-size: 0.75rem; } }\n"
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

const char* name_of(MarkKind kind)
{
    switch (kind)
    {
    case MarkKind::plain:
        return "plain";
    case MarkKind::warning:
        return "warning";
    case MarkKind::fault:
        return "fault";
    }
    return "plain";
}

/// Value rounded to the six digits that a reader of a chart can use.
double rounded(double value)
{
    return std::isfinite(value) ? std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr)
                                : value; // JSON writes it as null.
}

std::vector<double> rounded(const std::vector<double>& values)
{
    std::vector<double> result;
    std::ranges::transform(values, std::back_inserter(result),
                           [](double value) { return rounded(value); });
    return result;
}

/// JSON that is safe in any element: no character in it has a meaning in HTML or XML.
std::string to_json(const Chart& chart)
{
    using Json = nlohmann::ordered_json;
    Json lines = Json::array();
    for (const Line& line : chart.lines)
    {
        lines.push_back({{"name", line.name}, {"y", rounded(line.y)}});
    }
    Json marks = Json::array(); // Marks of one name are merged, since there may be thousands.
    for (const Mark& mark : chart.marks)
    {
        auto of_name = std::ranges::find_if(marks, [&](const Json& known)
                                            { return known["name"] == mark.name; });
        if (of_name == marks.end())
        {
            marks.push_back(
                {{"name", mark.name}, {"kind", name_of(mark.kind)}, {"x", Json::array()}});
            of_name = std::prev(marks.end());
        }
        (*of_name)["x"].push_back(rounded(mark.x));
    }
    const Json json{{"title", chart.title},
                    {"x_label", chart.x_label},
                    {"y_label", chart.y_label},
                    {"kind", chart.kind == Chart::Kind::series ? "series" : "histogram"},
                    {"x", rounded(chart.x)},
                    {"lines", lines},
                    {"marks", marks}};
    std::string safe;
    for (const char c : json.dump(-1, ' ', true, Json::error_handler_t::replace))
    {
        switch (c)
        {
        case '<':
            safe += "\\u003c";
            break;
        case '>':
            safe += "\\u003e";
            break;
        case '&':
            safe += "\\u0026";
            break;
        default:
            safe += c;
        }
    }
    return safe;
}

/// Script element. The CDATA marks make its content no markup in XML; in HTML they are comments of
/// the script.
std::string script_of(std::string_view text)
{
    return fmt::format("<script>//<![CDATA[\n{}\n//]]></script>\n", text);
}

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

/// Table row; its first cell is the header.
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

Page::Page(const std::string& title, ChartLibrary library)
    : title_(escaped(title)), library_(std::move(library))
{
}

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

void Page::relief(const Relief& relief)
{
    const std::string figure = figure_of(relief);
    has_relief_ = has_relief_ || !figure.empty();
    body_ += figure;
}

void Page::charts(const std::vector<Chart>& charts)
{
    if (charts.empty())
    {
        return;
    }
    if (!library_.missing.empty())
    {
        body_ += fmt::format("<p class=\"note\">{} charts are left out: {}</p>\n", charts.size(),
                             escaped(library_.missing));
        return;
    }
    if (charts_.empty())
    {
        body_ += "<p class=\"note\">Drag to zoom in. Drag with the shift key to move. Double-click "
                 "to show all.</p>\n<noscript><p>Allow scripts to see the charts.</p>"
                 "</noscript>\n";
    }
    body_ += "<div class=\"charts\">\n";
    for (const Chart& chart : charts)
    {
        charts_.push_back(to_json(chart));
        body_ +=
            fmt::format("<figure>\n<figcaption>{}</figcaption>\n<div class=\"legend\"></div>\n"
                        "<div class=\"chart\"></div>\n<div class=\"marks\"></div>\n</figure>\n",
                        escaped(chart.title));
    }
    body_ += "</div>\n";
}

std::string Page::scripts() const
{
    if (charts_.empty())
    {
        return {};
    }
    return fmt::format("<script type=\"application/json\" id=\"chart-data\">[{}]</script>\n{}{}",
                       fmt::join(charts_, ",\n"), script_of(library_.script),
                       script_of(charts_script()));
}

std::string Page::html() const
{
    const std::string style =
        (has_relief_ ? relief_style() : "") +
        (charts_.empty() ? "" : fmt::format("/*<![CDATA[*/\n{}\n/*]]>*/\n", library_.style));
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\" xmlns=\"http://www.w3.org/1999/xhtml\">\n<head>\n"
        "<meta charset=\"utf-8\"/>\n<meta http-equiv=\"Content-Security-Policy\" "
        "content=\"default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'\"/>\n"
        "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n"
        "<title>{0}</title>\n<style>\n{1}{2}</style>\n</head>\n<body>\n<h1>{0}</h1>\n{3}{4}"
        "</body>\n</html>\n",
        title_, style, kPageStyle, body_, scripts());
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
