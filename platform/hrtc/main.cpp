// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// hrtc, the haptic real-time controller: finds models, lays out the pools, runs the loop on its
/// real-time thread, and reports.

#include "host_tools/cli/command_line.hpp"
#include "host_tools/cli/progress.hpp"
#include "platform/hrtc/controller.hpp"
#include "platform/hrtc/haptic_loop.hpp"
#include "platform/hrtc/options.hpp"
#include "platform/hrtc/output_file.hpp"
#include "platform/hrtc/recorder.hpp"
#include "platform/hrtc/replay_file.hpp"
#include "platform/hrtc/report.hpp"
#include "platform/hrtc/safety_record.hpp"
#include "platform/hrtc/subcommands.hpp"
#include "platform/hrtc/supervisor.hpp"
#include "platform/hrtc/transport_thread.hpp"
#include "platform/posix/posix_clock.hpp"
#include "platform/posix/posix_periodic_timer.hpp"
#include "platform/system_call_trap.hpp"
#include "transport/dds/dds_client.hpp"
#include "transport/store/store_link.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <thread>

namespace tactus::hrtc
{
namespace
{

/// How long before the deadline the loop wakes to rehearse its queries.
constexpr Duration kMarginMost = microseconds(100);

std::atomic<bool> interrupted{false};
std::atomic<HapticLoop*> running_loop{nullptr};

void on_signal(int /*signal*/)
{
    interrupted.store(true);
}

/// On the haptic thread: brake, note it, and never return; the main thread ends the process.
void on_assertion(const char* condition, const char* file, int line) noexcept
{
    std::fprintf(stderr, "hrtc: internal error: %s (%s:%d)\n", condition, file, line);
    if (HapticLoop* loop = running_loop.load(); loop != nullptr)
    {
        loop->fail();
        for (;;)
        {
            std::this_thread::sleep_for(std::chrono::seconds(1));
        }
    }
    std::_Exit(kExitFailed);
}

/// One line whatever is in it: file names may hold control characters.
void log_line(std::string line)
{
    std::replace_if(
        line.begin(), line.end(),
        [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == 0x7F; }, '?');
    fmt::print(stderr, "hrtc: {}\n", line);
}

int fail(const std::string& text)
{
    log_line(text);
    return kExitFailed;
}

/// The models by file or network. The client must live as long as their links.
struct Found
{
    std::unique_ptr<dds::DdsClient> client;
    std::vector<ServedModel> models;
    std::string error;
};

Found find_in_files(const Options& options)
{
    Found found;
    for (const std::string& path : options.models)
    {
        const std::string name = std::filesystem::path(path).stem().string();
        auto model = serve_from_file(path, is_valid_name(name) ? name : "model", log_line);
        if (!model)
        {
            found.error = model.error().text;
            return found;
        }
        found.models.push_back(std::move(model).value());
    }
    return found;
}

Found find_published(const Options& options)
{
    Found found;
    auto client =
        dds::DdsClient::create(options.domain, fmt::format("hrtc-{}", getpid()), log_line);
    if (!client)
    {
        found.error = client.error().text;
        return found;
    }
    found.client = std::move(client).value();
    const auto wait = std::chrono::milliseconds(static_cast<std::int64_t>(options.wait_s * 1e3));
    for (const std::string& text : options.models)
    {
        auto model = found.client->find(parse_selector(text).value(), wait,
                                        [] { return !interrupted.load(); });
        if (!model)
        {
            found.error = model.error().text;
            return found;
        }
        found.models.push_back(std::move(model).value());
    }
    return found;
}

void install_signal_handlers()
{
    struct sigaction action
    {
    };
    action.sa_handler = on_signal;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

/// Ends the supervisor before its thread is waited for, however a run is left.
class StopAtEnd
{
public:
    explicit StopAtEnd(Supervisor& supervisor) noexcept : supervisor_(supervisor) {}
    StopAtEnd(const StopAtEnd&) = delete;
    StopAtEnd& operator=(const StopAtEnd&) = delete;
    ~StopAtEnd() { supervisor_.stop(); }

private:
    Supervisor& supervisor_;
};

/// What loop and supervisor have noted since the last time.
void take_events(HapticLoop& loop, Supervisor& supervisor, SafetyRecord& record)
{
    std::vector<SafetyEvent> events;
    loop.safety_log().take_into(events);
    supervisor.log().take_into(events);
    for (const SafetyEvent& event : events)
    {
        record.add(event);
    }
}

/// Waits for the loop's end, telling how far it is.
void wait_for_end(HapticLoop& loop, std::uint64_t frames, Supervisor& supervisor,
                  SafetyRecord& record)
{
    Progress progress("touch", "frames");
    while (!loop.is_done() && !loop.has_failed())
    {
        if (interrupted.load())
        {
            loop.stop();
        }
        progress.update(loop.frames_done(), frames);
        take_events(loop, supervisor, record);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

/// None when the budgets are to stay as they are.
std::optional<BudgetGovernor> make_governor(const Options& options, const Controller& controller)
{
    if (!options.frame_budget_us)
    {
        return std::nullopt;
    }
    const auto budget_ns = static_cast<std::int64_t>(*options.frame_budget_us * 1e3);
    const std::size_t pairs = controller.tools().size() * controller.poses().size();
    return BudgetGovernor(nanoseconds(budget_ns), controller.budgets(),
                          static_cast<std::uint32_t>(2 * pairs));
}

/// No recorder when none is wanted; returns why it can't be had.
std::optional<std::string> start_recorder(const Options& options, Controller& controller,
                                          std::optional<Recorder>& recorder)
{
    if (options.record_path.empty())
    {
        return std::nullopt;
    }
    auto file = OutputFile::create(options.record_path);
    if (!file)
    {
        return "--record: " + file.error().text;
    }
    recorder.emplace(std::move(file).value(), controller.setup(), controller.couriers());
    return std::nullopt;
}

/// The recording of a run that ended well or not; a refusal is logged.
std::optional<RecordingResult> finish_recording(std::optional<Recorder>& recorder)
{
    if (!recorder)
    {
        return std::nullopt;
    }
    const auto recording = recorder->finish();
    if (!recording)
    {
        log_line("--record: " + recording.error().text);
        return std::nullopt;
    }
    return recording.value();
}

/// On the haptic thread; returns why the option can't be had.
std::optional<std::string> trap_calls(const Options& options)
{
    if (!options.trap_system_calls)
    {
        return std::nullopt;
    }
    const auto set = system_call_trap::set_on_this_thread();
    return set ? std::nullopt : std::optional("--trap-system-calls: " + set.error().message);
}

int run(const Options& options, Controller& controller)
{
    const Duration period = nanoseconds(1'000'000'000 / options.rate_hz);
    const auto frames =
        static_cast<std::uint64_t>(options.duration_s * static_cast<double>(options.rate_hz));
    RunStatistics statistics(controller.tools().size(),
                             controller.tools().size() * controller.poses().size(),
                             controller.models().size(), period);
    const PosixClock clock;
    PosixPeriodicTimer timer;
    std::optional<BudgetGovernor> governor = make_governor(options, controller);
    std::optional<Recorder> recorder;
    if (const auto error = start_recorder(options, controller, recorder))
    {
        return fail(*error);
    }
    TransportThread transport(controller.couriers(), controller.models());
    HapticLoop loop({&controller.frame(), controller.devices(), controller.limits(),
                     controller.conditioners(), controller.poses(), &timer, &clock,
                     controller.budgets(), governor ? &*governor : nullptr,
                     recorder ? &recorder->tap() : nullptr, frames, &transport.hosts_gone()},
                    statistics);
    PosixPeriodicTimer alarm;
    Supervisor supervisor({controller.devices(), &loop.heartbeat(), &clock, &alarm, period});
    SafetyRecord safety(controller.tools().size());
    auto supervising = RtThread::start(Supervisor::thread_beside(options.thread),
                                       [&supervisor] { supervisor.run(); });
    if (!supervising)
    {
        return fail("supervisor: " + supervising.error().message);
    }
    const StopAtEnd stop_supervisor(supervisor);
    running_loop.store(&loop);
    const Duration margin = std::min(kMarginMost, nanoseconds(period.ns / 5));
    auto thread =
        RtThread::start(options.thread,
                        [&]
                        {
                            if (const auto error = trap_calls(options))
                            {
                                log_line(*error);
                                loop.fail();
                                return;
                            }
                            if (const auto started = timer.start(period, margin); !started)
                            {
                                log_line(started.error().message);
                                loop.fail();
                                return;
                            }
                            loop.run();
                        });
    if (!thread)
    {
        return fail(thread.error().message);
    }
    wait_for_end(loop, frames, supervisor, safety);
    if (loop.has_failed())
    {
        finish_recording(recorder); // Up to the frame that failed.
        std::fflush(nullptr);
        std::_Exit(kExitFailed);
    }
    thread.value().join();
    running_loop.store(nullptr);
    supervisor.stop();
    supervising.value().join();
    take_events(loop, supervisor, safety);
    safety.finish(supervisor.brakes(), loop.safety_log().lost() + supervisor.log().lost());
    transport.stop();
    const std::optional<RecordingResult> recording = finish_recording(recorder);
    for (const std::string& line : thread.value().report().refused)
    {
        log_line("without " + line);
    }
    const nlohmann::ordered_json report =
        make_report({controller, statistics, thread.value().report(), timer.counts(), period,
                     transport.host_was_lost(), options.frame_budget_us, options.trap_system_calls,
                     recording, safety, supervising.value().report().fifo});
    fmt::print("{}", make_summary(report));
    if (!options.report_path.empty())
    {
        if (const auto error = write_report(report, options.report_path))
        {
            return fail("--report: " + error->text);
        }
        fmt::print("report      {}\n", options.report_path);
    }
    return recorder && !recording ? kExitFailed : kExitDone;
}

int main_with(const Options& options)
{
    install_signal_handlers();
    set_assert_handler(on_assertion);
    if (!options.replay_path.empty())
    {
        return replay_file(options.replay_path, log_line);
    }
    const auto refused = probe_realtime(options.thread);
    if (!refused)
    {
        // The processor is the one option that only the system can judge.
        const bool is_usage = refused.error().kind == PlatformErrorKind::bad_option;
        log_line((is_usage ? "--cpu: " : "") + refused.error().message);
        return is_usage ? kExitUsage : kExitFailed;
    }
    if (!refused.value().empty() && !options.thread.allow_no_rt)
    {
        for (const std::string& line : refused.value())
        {
            log_line(line);
        }
        return fail("not run; --allow-no-rt runs it without");
    }
    for (const auto& [option, path] : {std::pair("--report: ", &options.report_path),
                                       std::pair("--record: ", &options.record_path)})
    {
        if (const auto error = probe_output(*path))
        {
            return fail(option + error->text);
        }
    }
    Found found =
        options.transport == TransportKind::file ? find_in_files(options) : find_published(options);
    if (!found.error.empty())
    {
        return fail(found.error);
    }
    auto controller = Controller::create(options, std::move(found.models), log_line);
    if (!controller)
    {
        return fail(controller.error().text);
    }
    return run(options, *controller.value());
}

} // namespace
} // namespace tactus::hrtc

int main(int argc, char** argv)
{
    try
    {
        if (const auto* subcommand = tactus::hrtc::find_subcommand(argc, argv))
        {
            return subcommand->run(argc - 1, argv + 1);
        }
        const auto parsed = tactus::hrtc::parse_options(argc, argv);
        if (const int* code = std::get_if<int>(&parsed))
        {
            return *code;
        }
        return tactus::hrtc::main_with(std::get<tactus::hrtc::Options>(parsed));
    }
    catch (const std::exception& error)
    {
        std::fprintf(stderr, "hrtc: %s\n", error.what());
        return tactus::kExitFailed;
    }
}
