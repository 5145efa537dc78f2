// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// tactus_bench: measures, and prints rows that can be compared from commit to commit.

#include "host_tools/cli/command_line.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "tests/bench/bench_report.hpp"
#include "tests/bench/force_trajectory.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/output_files.hpp"
#include "tests/bench/suites.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <iterator>

namespace tactus::bench
{
namespace
{

struct CommandLine
{
    std::string suite;
    OutputPaths paths;
    bool all{false};
    bool check{false};
    BenchOptions options;
};

constexpr const char* kEvery = "all"; ///< In place of a suite.

std::string suite_names()
{
    std::string names;
    for (const Suite& suite : all_suites())
    {
        names += std::string(suite.name) + ", ";
    }
    return names + kEvery;
}

/// None when there is no suite of that name.
std::vector<Suite> chosen_suites(const std::string& name)
{
    if (name == kEvery)
    {
        return all_suites();
    }
    const std::optional<Suite> suite = find_suite(name);
    return suite ? std::vector{*suite} : std::vector<Suite>{};
}

/// What a user may call a unit of length.
CLI::Validator unit_of_length()
{
    return CLI::Validator(
        [](std::string& text)
        {
            return metres_per_unit(text) ? std::string()
                                         : "'" + text + "' is no unit; allowed are mm, cm, m, in";
        },
        "mm, cm, m, in");
}

void declare_trajectory_options(CLI::App& app, TrajectoryOptions& options)
{
    CLI::Option* file = app.add_option(
        "--traj", options.file,
        "Suite force: replay this recording of positions and forces instead of the cases, and "
        "compare the forces; with --mesh");
    CLI::Option* mesh =
        app.add_option("--mesh", options.mesh, "With --traj: the mesh that was touched");
    file->needs(mesh);
    const auto add = [&](const char* name, auto& value, const char* text)
    { return app.add_option(name, value, text)->needs(file); };
    mesh->needs(file);
    add("--traj-unit", options.unit, "Unit of the recorded positions (default: mm)")
        ->check(unit_of_length());
    add("--mesh-unit", options.mesh_unit, "Unit of the mesh (default: mm)")
        ->check(unit_of_length());
    add("--traj-columns", options.columns,
        "What the columns are: t, x, y, z, fx, fy, fz or fn for the force's amount alone; _ for "
        "one to pass over, - before one of the other sign (default: t,x,y,z,fx,fy,fz)");
    add("--proxy-radius", options.proxy_radius_mm, "With --traj: in mm (default: 0.5)")
        ->check(number_between(kMinProxyRadius_mm, kMaxProxyRadius_mm));
    add("--stiffness", options.stiffness_n_per_m, "With --traj: in N/m (default: 500)")
        ->check(number_between(kMinStiffness_n_per_m, kMaxStiffness_n_per_m));
}

void declare_options(CLI::App& app, CommandLine& line)
{
    BenchOptions& options = line.options;
    app.set_version_flag("--version", std::string("tactus_bench ") + TACTUS_VERSION);
    app.add_option("SUITE", line.suite, "Suite to run, or all of them in turn: " + suite_names())
        ->required();
    app.add_flag(
        "--quick", options.quick,
        "Fewer frames and repeats; without the cases of 4 M faces unless --only names them");
    app.add_flag("--full", options.full, "All trials of the suite stability, for an hour");
    app.add_option("--only", options.only, "Run this case; may be given several times")->take_all();
    app.add_option("--cache", options.cache,
                   "Folder that keeps encoded models from run to run; without it they are encoded "
                   "each time")
        ->check(CLI::ExistingDirectory);
    app.add_option("--frames", options.frames, "Frames of each motion, instead of the usual number")
        ->check(number_between(kMinFrames, kMaxFrames));
    app.add_option("--passes", options.passes, "Warm replays, instead of the usual number")
        ->check(number_between(1, kMaxPasses));
    app.add_option("--core", options.core, "Core to measure on (default: the last one)");
    app.add_flag("--count", options.count,
                 "One warm pass, nothing evicted and no peers: for counting instructions");
    app.add_flag("--all", line.all, "Print every row, not only those with a goal");
    app.add_flag("--check", line.check, "Leave with code 1 when a goal is not met");
    app.add_option("--json", line.paths.json, "Write the rows to this file as JSON");
    app.add_option("--csv", line.paths.csv, "Write the rows to this file as CSV");
    app.add_option("--html", line.paths.html,
                   "Write the rows to this file as a page, with plots where they make some");
    declare_trajectory_options(app, options.trajectory);
}

/// The same for --traj and what belongs to it.
std::optional<std::string> wrong_trajectory(const CommandLine& line)
{
    const BenchOptions& options = line.options;
    if (options.trajectory.file.empty())
    {
        return options.trajectory.mesh.empty()
                   ? std::nullopt
                   : std::optional<std::string>("--traj: the name of a file must not be empty");
    }
    if (line.suite != "force")
    {
        return "--traj: only the suite force has it";
    }
    if (!options.only.empty() || options.frames)
    {
        return std::string(options.frames ? "--frames" : "--only") +
               ": not with --traj, which replays its file and no case";
    }
    const auto columns = TrajectoryColumns::parse(options.trajectory.columns);
    return columns ? std::nullopt : std::optional("--traj-columns: " + columns.error().text);
}

/// Why the command line makes no sense; nothing when it does.
std::optional<std::string> wrong_usage(const CommandLine& line)
{
    const std::vector<Suite> suites = chosen_suites(line.suite);
    if (suites.empty())
    {
        return "SUITE: there is no suite '" + line.suite + "'; there are: " + suite_names();
    }
    if (line.options.full && line.suite != "stability" && line.suite != kEvery)
    {
        return "--full: only the suite stability has it; the others do all without --quick";
    }
    if (line.suite == kEvery && !line.options.only.empty())
    {
        return "--only: not with all, which runs every case; name the suite that has the case";
    }
    const std::vector<std::string> names = case_names(suites.front());
    for (const std::string& name : line.options.only)
    {
        if (std::find(names.begin(), names.end(), name) == names.end())
        {
            return fmt::format("--only: there is no case '{}'; there are: {}", name,
                               fmt::join(names, ", "));
        }
    }
    if (line.options.core != -1 && !may_use_core(line.options.core))
    {
        return fmt::format("--core {}: this process may not run there", line.options.core);
    }
    if (const auto reason = line.paths.wrong_usage())
    {
        return reason;
    }
    return wrong_trajectory(line);
}

/// All suites of the line, one after the other, printed as they come; what came before a failure,
/// too. `laws`: goals that leave with code 1, asked or not.
Results run_suites(const CommandLine& line, GoalCount& laws)
{
    Results results;
    for (const Suite& suite : chosen_suites(line.suite))
    {
        Results own;
        SceneStore scenes(line.options.cache); // Its own: what others needed is not kept in memory.
        if (const auto refused = run_suite(suite, line.options, scenes, own))
        {
            results.failures.push_back(*refused);
        }
        fmt::print("{}", line.all ? to_table(own.rows) : suite.to_table(own.rows));
        const GoalCount count = count_goals(own.rows);
        laws.goals += suite.always_checks ? count.goals : 0;
        laws.met += suite.always_checks ? count.met : 0;
        std::ranges::move(own.rows, std::back_inserter(results.rows));
        std::ranges::move(own.series, std::back_inserter(results.series));
    }
    return results;
}

Results run_trajectory(const CommandLine& line)
{
    Results results;
    if (const auto refused = compare_trajectory(line.options, results.rows))
    {
        results.failures.push_back(*refused);
    }
    fmt::print("{}", line.all ? to_table(results.rows) : to_columns(results.rows));
    return results;
}

int run(int argc, char** argv)
{
    CLI::App app("Measures Tactus. Times are per-frame least values of repeated replays.",
                 "tactus_bench");
    CommandLine line;
    declare_options(app, line);
    if (const std::optional<int> code = parse_command_line(app, argc, argv))
    {
        return *code;
    }
    if (const auto reason = wrong_usage(line))
    {
        return fail(app, *reason, kExitUsage);
    }
    AtomicFile::remove_pending_on_signal();
    auto files = OutputFiles::create(line.paths);
    if (!files)
    {
        return fail(app, files.error().text);
    }
    const RunFacts facts{PinnedCore(line.options.core).core(), line.options.quick};
    const bool is_recorded = !line.options.trajectory.file.empty();
    GoalCount laws;
    const Results results = is_recorded ? run_trajectory(line) : run_suites(line, laws);
    int code = kExitDone;
    for (const std::string& failure : results.failures)
    {
        code = fail(app, failure, is_recorded ? kExitFailed : kExitCriterionNotMet);
    }
    if (is_recorded && code != kExitDone)
    {
        return code;
    }
    fmt::print("{}\n", facts.core < 0 ? std::string("not held to one core: the system refuses")
                                      : fmt::format("measured on core {}", facts.core));
    if (const auto written = files.value().write(results, facts); !written)
    {
        return fail(app, written.error().text);
    }
    const GoalCount count = count_goals(results.rows);
    const bool misses = laws.met < laws.goals || (line.check && count.met < count.goals);
    return misses ? kExitCriterionNotMet : code;
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
