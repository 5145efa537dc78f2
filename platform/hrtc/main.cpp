// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Program hrtc, the haptic real-time controller. It finds models, lays out the pools, runs the
/// loop on its real-time thread, and reports.

#include "platform/choices/messages.hpp"
#include "platform/controller/controller.hpp"
#include "platform/controller/finished_run.hpp"
#include "platform/controller/session.hpp"
#include "platform/hrtc/subcommands.hpp"
#include "platform/loop/assertion_brake.hpp"
#include "platform/machine/thread_usage.hpp"
#include "platform/options/options.hpp"
#include "platform/program/command_line.hpp"
#include "platform/program/run_program.hpp"
#include "platform/report/report.hpp"
#include "platform/report/verdict.hpp"
#include "transport/base/atomic_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <string_view>
#include <variant>

namespace tactus::hrtc
{
namespace
{

int touch(const Options& options)
{
    stop_on_signals();
    watch_process_stops();
    install_assertion_brake();
    if (!options.replay_path.empty())
    {
        return replay_file(options.replay_path, options.kernels, options.export_paths, log_error);
    }
    auto session = Session::open(options, program_hooks());
    if (!session)
    {
        return leave_with(session.error());
    }
    print_out(start_lines(session.value()->options(), session.value()->controller()));
    const auto done = session.value()->run("touch");
    if (!done)
    {
        return leave_with(done.error());
    }
    const nlohmann::ordered_json report =
        make_report(options, session.value()->controller(), done.value());
    print_out(make_summary(report));
    for (const std::string& path : options.report_paths)
    {
        const auto error =
            is_page_name(path)
                ? write_text(
                      make_page(report, done.value().statistics, plot::ChartLibrary::packaged(),
                                relief_of(session.value()->controller(), done.value().statistics)),
                      path)
                : write_report(report, path);
        if (error)
        {
            return leave_with(failure("--report: " + error->text));
        }
        print_out(fmt::format("report      {}\n", path));
    }
    if (!options.histograms_folder.empty())
    {
        if (const auto error = write_histograms(done.value().statistics, options.histograms_folder))
        {
            return leave_with(failure("--histograms: " + error->text));
        }
        print_out(fmt::format("histograms  {}\n", options.histograms_folder));
    }
    if (done.value().recording_error || done.value().trace_error || done.value().has_other_device)
    {
        return kExitFailed;
    }
    return options.strict && has_loss(complaints_of(report)) ? kExitCriterionNotMet : kExitDone;
}

int run(int argc, char** argv)
{
    char help[] = "--help";
    if (argc > 1 && std::string_view(argv[1]) == "help")
    {
        argv[1] = help;
    }
    if (const auto* subcommand = find_subcommand(argc, argv))
    {
        return subcommand->run(argc - 1, argv + 1);
    }
    const auto parsed = parse_options(argc, argv, program_form());
    if (const int* code = std::get_if<int>(&parsed))
    {
        return *code;
    }
    return touch(std::get<Options>(parsed));
}

} // namespace
} // namespace tactus::hrtc

int main(int argc, char** argv)
{
    return tactus::run_program("hrtc", "", [&] { return tactus::hrtc::run(argc, argv); });
}
