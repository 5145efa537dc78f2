// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// tactus_bench: measures, and prints rows that can be compared from commit to commit.

#include "host_tools/cli/command_line.hpp"
#include "host_tools/mesh/atomic_file.hpp"
#include "tests/bench/bench_row.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <exception>
#include <map>
#include <span>

namespace tactus::bench
{
namespace
{

int run(int argc, char** argv)
{
    static const std::map<std::string, Suite> kSuites{{"frame", run_frame_suite}};
    CLI::App app("Measures Tactus. Times are per-frame least values of repeated replays.",
                 "tactus_bench");
    std::string suite;
    std::string json_path;
    BenchOptions options;
    app.add_option("SUITE", suite, "Suite to run: frame")->required();
    app.add_flag("--quick", options.quick, "Fewer frames and repeats, the same cases");
    app.add_option("--json", json_path, "Write the rows to this file as JSON");
    app.set_version_flag("--version", std::string("tactus_bench ") + TACTUS_VERSION);
    if (const std::optional<int> code = parse_command_line(app, argc, argv))
    {
        return *code;
    }
    const auto found = kSuites.find(suite);
    if (found == kSuites.end())
    {
        return fail(app, "SUITE: there is no suite '" + suite + "'; there is: frame", kExitUsage);
    }
    Rows rows;
    if (const auto failure = found->second(options, rows))
    {
        return fail(app, *failure, kExitCriterionNotMet);
    }
    fmt::print("{}", to_table(rows));
    if (!json_path.empty())
    {
        const std::string json = to_json(rows);
        auto file = AtomicFile::create(json_path);
        if (!file)
        {
            return fail(app, file.error().text);
        }
        if (const auto written = file.value().write(std::as_bytes(std::span(json))); !written)
        {
            return fail(app, written.error().text);
        }
        if (const auto done = file.value().commit(); !done)
        {
            return fail(app, done.error().text);
        }
    }
    return kExitDone;
}

} // namespace
} // namespace tactus::bench

int main(int argc, char** argv)
{
    try
    {
        return tactus::bench::run(argc, argv);
    }
    catch (const std::exception& error)
    {
        fmt::print(stderr, "tactus_bench: {}\n", error.what());
        return tactus::kExitFailed;
    }
}
