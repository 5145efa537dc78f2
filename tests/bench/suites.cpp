// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/suites.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <iterator>

namespace tactus::bench
{

Row CaseContext::common_row(const std::string& scene, const char* part) const
{
    Row common;
    common.suite = suite;
    common.part = part;
    common.test_case = name;
    common.scene = scene;
    common.seed = kSeed;
    return common;
}

std::vector<Suite> all_suites()
{
    return {counts_suite(),    frame_suite(), error_time_suite(), skip_suite(),   growth_suite(),
            peers_suite(),     force_suite(), encoder_suite(),    table1_suite(), table2_suite(),
            stability_suite(), scene_suite(), starve_suite(),     stream_suite(), worst_suite(),   edits_suite()};
}

std::optional<Suite> find_suite(const std::string& name)
{
    const std::vector<Suite> suites = all_suites();
    const auto found = std::ranges::find(suites, name, &Suite::name);
    return found == suites.end() ? std::nullopt : std::optional(*found);
}

std::vector<std::string> case_names(const Suite& suite)
{
    std::vector<std::string> names;
    std::ranges::transform(suite.cases(), std::back_inserter(names), &Case::name);
    return names;
}

std::optional<std::string> run_suite(const Suite& suite, const BenchOptions& options,
                                     SceneStore& scenes, Rows& rows)
{
    for (const Case& one : suite.cases())
    {
        if (!is_chosen(options, one.name, one.when))
        {
            continue;
        }
        fmt::print(stderr, "{}\n", one.name);
        const std::size_t rows_before = rows.size();
        try
        {
            one.run({suite.name, one.name, options, scenes, rows});
            check_hashes(std::span(rows).subspan(rows_before));
        }
        catch (const std::exception& error) // Includes exceptions of libraries and the system.
        {
            return fmt::format("{} {}: {}", suite.name, one.name, error.what());
        }
    }
    return std::nullopt;
}

void check_hashes(std::span<const Row> rows)
{
    constexpr std::array kTimes{"s", "ms", "us", "ns"};
    for (const Row& row : rows)
    {
        const bool is_time = std::ranges::find(kTimes, row.unit) != kTimes.end();
        if (is_time && row.frames > 0 && row.hash == 0)
        {
            throw Failure(fmt::format("{}: its result goes unused, no hash is over its {} frames",
                                      row.metric, row.frames));
        }
    }
}

} // namespace tactus::bench
