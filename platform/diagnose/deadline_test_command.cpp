// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/messages.hpp"
#include "platform/controller/finished_run.hpp"
#include "platform/controller/session.hpp"
#include "platform/diagnose/commands.hpp"
#include "platform/diagnose/deadline_report.hpp"
#include "platform/diagnose/load.hpp"
#include "platform/diagnose/self_check.hpp"
#include "platform/loop/assertion_brake.hpp"
#include "platform/machine/thread_usage.hpp"
#include "platform/options/options.hpp"
#include "platform/program/command_line.hpp"
#include "platform/program/run_program.hpp"
#include "platform/report/report.hpp"
#include "transport/base/atomic_file.hpp"
#include "transport/base/refusal.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <vector>

namespace tactus::hrtc
{

namespace
{

constexpr double kDuration_s = 60.0;

/// Path of a temporary recording, which the destructor removes.
class TemporaryRecording
{
public:
    TemporaryRecording()
        : path_((std::filesystem::temp_directory_path() /
                 fmt::format("hrtc-deadline-test-{}.rec", getpid()))
                    .string())
    {
    }
    TemporaryRecording(const TemporaryRecording&) = delete;
    TemporaryRecording& operator=(const TemporaryRecording&) = delete;
    ~TemporaryRecording()
    {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }

    [[nodiscard]] const std::string& path() const noexcept { return path_; }

private:
    std::string path_;
};

/// Replays the suspected frames to judge them. Returns the reason if that isn't possible.
std::optional<std::string> settle(FinishedRun& run, const std::string& recording_path)
{
    DeadlineAccount& deadlines = run.statistics.deadlines;
    const std::vector<std::uint64_t> suspects = deadlines.suspects();
    if (suspects.empty())
    {
        return std::nullopt;
    }
    const auto recording = Recording::read(recording_path);
    if (!recording)
    {
        return recording.error().text;
    }
    const auto over = frames_over_again(recording.value(), suspects, deadlines.repetition_limit());
    if (!over)
    {
        return "frames that took long can't be repeated: " + over.error();
    }
    deadlines.settle(over.value());
    return std::nullopt;
}

/// Runs the session beside the load, which ends before the return.
Result<FinishedRun, Refusal> run_beside(Session& session, const std::string& name,
                                        const std::vector<LoadKind>& loads)
{
    auto load = Load::start(loads, "/proc/self/exe");
    if (!load)
    {
        return failure("--load: " + load.error());
    }
    auto run = session.run(name);
    if (is_stop_requested()) // The same signal may have ended the load.
    {
        return interruption();
    }
    if (const auto ended = load.value().ended(); run && ended)
    {
        return failure(fmt::format("--load: '{}' ended before the run did",
                                   kLoadNames[static_cast<std::size_t>(*ended)]));
    }
    return run;
}

Result<DeadlinePhase, Refusal> run_phase(Options options, const std::vector<LoadKind>& loads)
{
    const TemporaryRecording recording;
    options.record_path = recording.path();
    auto session = Session::open(options, program_hooks());
    if (!session)
    {
        return session.error();
    }
    const std::string name = loads.empty() ? "alone" : "beside load";
    auto run = run_beside(*session.value(), name, loads);
    if (!run)
    {
        return run.error();
    }
    if (run.value().recording_error)
    {
        return failure("the run can't be judged without its recording");
    }
    if (const auto fault = settle(run.value(), recording.path()))
    {
        return failure(*fault);
    }
    const RunStatistics& statistics = run.value().statistics;
    DeadlinePhase phase{.name = name,
                        .loads = {},
                        .report = make_report(options, session.value()->controller(), run.value()),
                        .wake = statistics.wake,
                        .cpu = statistics.cpu,
                        .response = statistics.deadlines.response()};
    for (const LoadKind kind : loads)
    {
        phase.loads.emplace_back(kLoadNames[static_cast<std::size_t>(kind)]);
    }
    return phase;
}

/// Paths of the JSON file and of the .txt and .html files beside it.
struct ReportFiles
{
    std::string json;
    std::string text;
    std::string page;
};

ReportFiles files_beside(const std::string& path)
{
    const auto with = [&path](const char* extension)
    { return std::filesystem::path(path).replace_extension(extension).string(); };
    return {path, with(".txt"), with(".html")};
}

std::optional<Refusal> write_files(const ReportFiles& files, const SelfCheck& check,
                                   std::span<const DeadlinePhase> phases,
                                   const DeadlineSetting& setting)
{
    if (auto error = write_report(make_deadline_report(check, phases), files.json))
    {
        return error;
    }
    if (auto error = write_text(make_histogram_text(phases), files.text))
    {
        return error;
    }
    return write_text(make_histogram_page(check, phases, setting, plot::ChartLibrary::packaged()),
                      files.page);
}

/// Parses the names of --load. Returns the fault; empty if there is none.
std::string check_load(const std::vector<std::string>& names, std::vector<LoadKind>& loads)
{
    for (const std::string& name : names)
    {
        if (name == "none" && names.size() > 1)
        {
            return "--load: none goes with no other";
        }
        if (const auto kind = parse_load(name); kind && std::ranges::count(loads, *kind) == 0)
        {
            loads.push_back(*kind);
        }
    }
    return {};
}

std::optional<Refusal> probe(const ReportFiles& files)
{
    for (const std::string* path : {&files.json, &files.text, &files.page})
    {
        if (auto error = probe_output(*path))
        {
            return error;
        }
    }
    return std::nullopt;
}

/// Fault of --report; empty if there is none.
std::string check_report(const std::vector<std::string>& paths)
{
    if (paths.size() > 1)
    {
        return "--report: one name is enough, the three files are called by it";
    }
    return !paths.empty() && is_page_name(paths.front())
               ? "--report: must end in .json; a .txt and an .html of the same name go beside it"
               : "";
}

int run_test(const Options& options, const std::vector<LoadKind>& loads)
{
    stop_on_signals();
    watch_process_stops();
    install_assertion_brake();
    const bool has_files = !options.report_paths.empty();
    const ReportFiles files =
        has_files ? files_beside(options.report_paths.front()) : ReportFiles{};
    if (const auto error = probe(files))
    {
        return leave_with(failure("--report: " + error->text));
    }
    const auto check = run_self_check(options);
    if (!check)
    {
        return leave_with(check.error());
    }
    std::vector<DeadlinePhase> phases;
    std::vector<std::vector<LoadKind>> runs{{}};
    if (!loads.empty())
    {
        runs.push_back(loads);
    }
    for (const std::vector<LoadKind>& beside : runs)
    {
        auto phase = run_phase(options, beside);
        if (!phase)
        {
            return leave_with(phase.error());
        }
        phases.push_back(std::move(phase).value());
    }
    const DeadlineSetting setting{options.thread.priority, options.period()};
    print_out(make_deadline_summary(check.value(), phases, setting));
    if (has_files)
    {
        if (const auto error = write_files(files, check.value(), phases, setting))
        {
            return leave_with(failure("--report: " + error->text));
        }
        print_out(fmt::format("report      {}, {}, {}\n", files.json, files.text, files.page));
    }
    return is_passed(check.value(), phases) ? kExitDone : kExitCriterionNotMet;
}

} // namespace

int run_deadline_test(int argc, char** argv, CommandForm form)
{
    std::vector<std::string> load_names{kLoadNames.begin(), kLoadNames.end()};
    form.footer.clear();
    form.name = "hrtc deadline-test";
    form.description =
        "Runs the haptic loop alone and beside load, and reports the cause of each missed "
        "deadline. Before the runs, injected faults prove that the test detects them. Exit code 1 "
        "after an overrun or an undetected fault. Takes the options of hrtc. --report FILE.json "
        "also writes FILE.txt and FILE.html.";
    form.records = false;
    form.duration_s = kDuration_s;
    form.declare = [&load_names](CommandLine& line)
    {
        line.add_option(
                "--load", load_names,
                "Load beside the second run: cpu, memory, disk, separated by commas, or none")
            .separated_by(',')
            .one_of({"cpu", "memory", "disk", "none"})
            .show_default();
    };
    auto parsed = parse_options(argc, argv, form);
    if (const int* code = std::get_if<int>(&parsed))
    {
        return *code;
    }
    const Options& options = std::get<Options>(parsed);
    std::vector<LoadKind> loads;
    if (const std::string fault = check_load(load_names, loads); !fault.empty())
    {
        return leave_with({.text = fault, .is_usage = true});
    }
    if (const std::string fault = check_report(options.report_paths); !fault.empty())
    {
        return leave_with({.text = fault, .is_usage = true});
    }
    return run_test(options, loads);
}

} // namespace tactus::hrtc
