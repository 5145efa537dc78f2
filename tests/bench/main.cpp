// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// tactus_bench: measures, and prints rows that can be compared between commits.

#include "platform/program/command_line.hpp"
#include "platform/program/run_program.hpp"
#include "tests/bench/bench_report.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/suites.hpp"
#include "transport/base/atomic_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>

namespace tactus::bench
{
namespace
{

struct Request
{
    std::string suite;
    std::string json; ///< Output file; empty: none.
    bool check{false};
    BenchOptions options;
};

constexpr const char* kEvery = "all"; ///< Name of all suites together.

std::string suite_names()
{
    std::string names;
    for (const Suite& suite : all_suites())
    {
        names += std::string(suite.name) + ", ";
    }
    return names + kEvery;
}

/// Suites of that name; empty if there is none.
std::vector<Suite> chosen_suites(const std::string& name)
{
    if (name == kEvery)
    {
        return all_suites();
    }
    const std::optional<Suite> suite = find_suite(name);
    return suite ? std::vector{*suite} : std::vector<Suite>{};
}

void declare_options(CommandLine& line, Request& request)
{
    BenchOptions& options = request.options;
    line.add_version("tactus_bench " TACTUS_VERSION);
    line.add_option("SUITE", request.suite,
                    "Suite to run, or all of them in turn: " + suite_names())
        .required();
    line.add_flag(
        "--quick", options.quick,
        "Fewer frames and repeats; without the cases of 4 M faces unless --only names them");
    line.add_flag("--full", options.full, "All trials of the suite stability, for an hour");
    line.add_option("--only", options.only, "Run this case; may be given several times");
    line.add_option("--cache", options.cache,
                    "Folder that keeps encoded models from run to run; without it they are encoded "
                    "each time")
        .existing_directory();
    line.add_option("--frames", options.frames,
                    "Frames of each motion, instead of the usual number")
        .number_between(kMinFrames, kMaxFrames);
    line.add_option("--passes", options.passes, "Warm replays, instead of the usual number")
        .number_between(1, kMaxPasses);
    line.add_option("--core", options.core, "Core to measure on (default: the last one)");
    line.add_flag("--count", options.count,
                  "One warm pass, nothing evicted and no peers: for counting instructions");
    line.add_flag("--instructions", options.instructions,
                  "Suites frame, skip, scene and worst: count instructions as well, by valgrind; "
                  "takes some 20 times as long");
    line.add_flag("--check", request.check, "Leave with code 1 when a goal is not met");
    line.add_option("--json", request.json, "Write the rows to this file as JSON");
}

/// Fault of the command line, if any.
std::optional<std::string> wrong_usage(const Request& request)
{
    const std::vector<Suite> suites = chosen_suites(request.suite);
    if (suites.empty())
    {
        return "SUITE: there is no suite '" + request.suite + "'; there are: " + suite_names();
    }
    if (request.options.full && request.suite != "stability" && request.suite != kEvery)
    {
        return "--full: only the suite stability has it; the others do all without --quick";
    }
    if (request.suite == kEvery && !request.options.only.empty())
    {
        return "--only: not with all, which runs every case; name the suite that has the case";
    }
    const std::vector<std::string> names = case_names(suites.front());
    for (const std::string& name : request.options.only)
    {
        if (std::find(names.begin(), names.end(), name) == names.end())
        {
            return fmt::format("--only: there is no case '{}'; there are: {}", name,
                               fmt::join(names, ", "));
        }
    }
    if (request.options.core != -1 && !may_use_core(request.options.core))
    {
        return fmt::format("--core {}: this process may not run there", request.options.core);
    }
    return std::nullopt;
}

/// Options that make the run less than a full one, for the record of its results.
std::vector<std::string> lesser_options(const BenchOptions& options)
{
    std::vector<std::string> told;
    for (const auto& [is_given, name] :
         {std::pair{options.quick, "--quick"}, {options.count, "--count"}})
    {
        if (is_given)
        {
            told.emplace_back(name);
        }
    }
    for (const auto& [number, name] :
         {std::pair{options.frames, "--frames"}, {options.passes, "--passes"}})
    {
        if (number)
        {
            told.push_back(fmt::format("{} {}", name, *number));
        }
    }
    std::ranges::transform(options.only, std::back_inserter(told),
                           [](const std::string& name) { return fmt::format("--only {}", name); });
    return told;
}

/// Runs and prints all requested suites in turn, also results before a failure. `laws` counts the
/// goals that cause exit code 1 even without a request.
Results run_suites(const Request& request, GoalCount& laws)
{
    Results results;
    for (const Suite& suite : chosen_suites(request.suite))
    {
        Rows own;
        SceneStore scenes(
            // One store a suite, so that models of other suites are not kept in memory.
            request.options.cache);
        if (const auto refused = run_suite(suite, request.options, scenes, own))
        {
            results.failures.push_back(*refused);
        }
        fmt::print("{}", to_text(own));
        const GoalCount count = count_goals(own);
        laws.goals += suite.always_checks ? count.goals : 0;
        laws.met += suite.always_checks ? count.met : 0;
        std::ranges::move(own, std::back_inserter(results.rows));
    }
    return results;
}

Result<Done, Refusal> write_json(AtomicFile& file, const std::string& text)
{
    const auto written = file.write(std::as_bytes(std::span(text)));
    return written ? file.commit() : written;
}

int run(int argc, char** argv)
{
    CommandLine line("tactus_bench",
                     "Measures Tactus. Times are per-frame least values of repeated replays.");
    Request request;
    declare_options(line, request);
    if (const std::optional<int> code = line.parse(argc, argv))
    {
        return *code;
    }
    if (const auto reason = wrong_usage(request))
    {
        return line.fail(*reason, kExitUsage);
    }
    AtomicFile::remove_pending_on_signal();
    // The file is created before the run, so that a bad name does not lose an hour of results.
    std::optional<AtomicFile> json;
    if (!request.json.empty())
    {
        auto made = AtomicFile::create(request.json);
        if (!made)
        {
            return line.fail(made.error().text);
        }
        json.emplace(std::move(made).value());
    }
    const RunFacts facts{PinnedCore(request.options.core).core(), request.options.quick,
                         lesser_options(request.options)};
    GoalCount laws;
    const Results results = run_suites(request, laws);
    int code = kExitDone;
    for (const std::string& failure : results.failures)
    {
        code = line.fail(failure, kExitCriterionNotMet);
    }
    fmt::print("{}\n", facts.core < 0 ? std::string("not held to one core: the system refuses")
                                      : fmt::format("measured on core {}", facts.core));
    if (json)
    {
        if (const auto written = write_json(*json, to_json(results, facts)); !written)
        {
            return line.fail(written.error().text);
        }
    }
    const GoalCount count = count_goals(results.rows);
    const bool misses = laws.met < laws.goals || (request.check && count.met < count.goals);
    return misses ? kExitCriterionNotMet : code;
}

} // namespace
} // namespace tactus::bench

int main(int argc, char** argv)
{
    return tactus::run_program("tactus_bench", "", [&] { return tactus::bench::run(argc, argv); });
}
