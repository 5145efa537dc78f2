// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Rows as a page for people.

#include "platform/hrtc/machine.hpp"
#include "tests/bench/bench_report.hpp"
#include "tests/bench/row_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace tactus::bench
{

namespace
{

std::vector<plot::Drawing> drawings_of(const std::string& suite, const Rows& rows,
                                       const std::vector<StageSeries>& all_series)
{
    if (suite == "error_time")
    {
        return error_time_plots(rows);
    }
    if (suite == "growth")
    {
        return growth_plots(rows);
    }
    if (suite == "skip")
    {
        return skip_plots(rows);
    }
    std::vector<StageSeries> series;
    std::ranges::copy_if(all_series, std::back_inserter(series),
                         [&](const StageSeries& one) { return one.suite == suite; });
    return series_plots(series);
}

/// One table, or one for each part.
void add_tables(const Rows& rows, plot::Page& page)
{
    for (const auto& [part, of_part] : grouped_by(rows, &Row::part))
    {
        if (!part.empty())
        {
            page.subheading(part);
        }
        page.table(has_quantiles(of_part) ? figure_table(of_part, Figures::all)
                                          : column_tables(of_part).front().table);
    }
}

void add_verdict(const Results& results, plot::Page& page)
{
    for (const std::string& failure : results.failures)
    {
        page.verdict(failure, false);
    }
    if (const GoalCount count = count_goals(results.rows); count.goals > 0)
    {
        page.verdict(fmt::format("{} of {} goals met", count.met, count.goals),
                     count.met == count.goals);
    }
}

/// Hashes and seeds stand with the rows of files; here, what they were measured on.
plot::Table machine_table(const RunFacts& facts)
{
    const hrtc::Machine machine = hrtc::describe_machine();
    return plot::facts(
        {{"commit", TACTUS_COMMIT},
         {"date", machine.date_utc},
         {"kernel", machine.kernel + ", " + machine.preemption},
         {"processor", fmt::format("{}, {} of them", machine.processor, machine.processors)},
         {"load", fmt::format("{:.2f}", machine.load_average)},
         {"core", facts.core < 0 ? std::string("not held to one") : fmt::format("{}", facts.core)},
         {"compiler", __VERSION__},
         {"frames and repeats", facts.quick ? "fewer, by --quick" : "the usual"}});
}

} // namespace

std::string to_page(const Results& results, const RunFacts& facts)
{
    plot::Page page("tactus_bench");
    add_verdict(results, page);
    page.table(machine_table(facts));
    for (const auto& [suite, rows] : grouped_by(results.rows, &Row::suite))
    {
        page.heading(suite);
        page.drawings(drawings_of(suite, rows, results.series));
        add_tables(rows, page);
    }
    return page.html();
}

} // namespace tactus::bench
