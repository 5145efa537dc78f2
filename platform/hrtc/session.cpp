// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/session.hpp"

#include "host_tools/cli/command_line.hpp"
#include "host_tools/cli/progress.hpp"
#include "platform/hrtc/haptic_loop.hpp"
#include "platform/hrtc/output_file.hpp"
#include "platform/hrtc/supervisor.hpp"
#include "platform/hrtc/transport_thread.hpp"
#include "platform/posix/linux_extras.hpp"
#include "platform/posix/posix_clock.hpp"
#include "platform/posix/posix_periodic_timer.hpp"
#include "platform/posix/service_notify.hpp"
#include "platform/system_call_trap.hpp"
#include "transport/store/store_link.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <thread>
#include <unistd.h>

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

Result<std::vector<ServedModel>, SessionError> find_in_files(const Options& options)
{
    std::vector<ServedModel> models;
    for (const std::string& path : options.models)
    {
        const std::string name = std::filesystem::path(path).stem().string();
        auto model = serve_from_file(path, is_valid_name(name) ? name : "model", log_line);
        if (!model)
        {
            return failure(model.error().text);
        }
        models.push_back(std::move(model).value());
    }
    return models;
}

/// The client must live as long as the models' links.
Result<std::vector<ServedModel>, SessionError> find_published(const Options& options,
                                                              dds::DdsClient& client)
{
    std::vector<ServedModel> models;
    const auto wait = std::chrono::milliseconds(static_cast<std::int64_t>(options.wait_s * 1e3));
    for (const std::string& text : options.models)
    {
        auto model =
            client.find(parse_selector(text).value(), wait, [] { return !interrupted.load(); });
        if (!model)
        {
            return failure(model.error().text);
        }
        models.push_back(std::move(model).value());
    }
    return models;
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
                  SafetyRecord& record, const std::string& what)
{
    Progress progress(what, "frames");
    const PosixClock clock;
    ServiceNotify manager;
    manager.ready();
    std::uint64_t seen = 0;
    while (!loop.is_done() && !loop.has_failed())
    {
        if (interrupted.load())
        {
            loop.stop();
        }
        const std::uint64_t done = loop.frames_done();
        if (done > seen)
        {
            manager.alive(clock.now());
        }
        seen = done;
        progress.update(done, frames);
        take_events(loop, supervisor, record);
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    manager.stopping();
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

/// The haptic thread's body.
void run_loop(const Options& options, HapticLoop& loop, PeriodicTimer& timer, Duration period)
{
    if (const auto error = trap_calls(options))
    {
        log_line(*error);
        loop.fail();
        return;
    }
    if (const auto started = timer.start(period, std::min(kMarginMost, {period.ns / 5})); !started)
    {
        log_line(started.error().message);
        loop.fail();
        return;
    }
    loop.run();
}

/// Of a run that ended well or not; a refusal is logged.
void finish_recording(std::optional<Recorder>& recorder, FinishedRun& done)
{
    if (!recorder)
    {
        return;
    }
    const auto recording = recorder->finish();
    if (!recording)
    {
        done.recording_error = recording.error().text;
        log_line("--record: " + *done.recording_error);
        return;
    }
    done.recording = recording.value();
}

/// What hosts and controller told each other; the threads between which it went have ended.
void note_topics(const HostTopics* topics, const PoseDoor& door, FinishedRun& done)
{
    if (topics != nullptr)
    {
        done.pose_uses.assign(door.uses().begin(), door.uses().end());
        done.pose_counts = topics->pose_counts();
        done.telemetry_sent = topics->telemetry_sent();
    }
}

/// None when all that the options ask of the machine can be had or done without.
std::optional<SessionError> check_machine(const Options& options)
{
    const auto refused = probe_realtime(options.thread);
    if (!refused)
    {
        // The processor is the one option that only the system can judge.
        const bool is_usage = refused.error().kind == PlatformErrorKind::bad_option;
        return SessionError{(is_usage ? "--cpu: " : "") + refused.error().message,
                            is_usage ? kExitUsage : kExitFailed};
    }
    if (!refused.value().empty() && !options.thread.allow_no_rt)
    {
        for (const std::string& line : refused.value())
        {
            log_line(line);
        }
        return failure("not run; --allow-no-rt runs it without");
    }
    return std::nullopt;
}

} // namespace

void log_line(std::string line)
{
    std::replace_if(
        line.begin(), line.end(),
        [](char c) { return static_cast<unsigned char>(c) < 0x20U || c == 0x7F; }, '?');
    fmt::print(stderr, "hrtc: {}\n", line);
}

void install_handlers()
{
    struct sigaction action
    {
    };
    action.sa_handler = on_signal;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
    set_assert_handler(on_assertion);
}

bool was_interrupted() noexcept
{
    return interrupted.load();
}

SessionError failure(std::string text)
{
    return {std::move(text), kExitFailed};
}

int leave_with(const SessionError& error)
{
    log_line(error.text);
    return error.code;
}

SessionError interruption()
{
    return failure("interrupted; nothing is judged");
}

Result<std::unique_ptr<Session>, SessionError> Session::open(const Options& options)
{
    if (auto error = check_machine(options))
    {
        return *error;
    }
    for (const auto& [option, path] : {std::pair("--report: ", &options.report_path),
                                       std::pair("--record: ", &options.record_path)})
    {
        if (const auto error = probe_output(*path))
        {
            return failure(option + error->text);
        }
    }
    if (options.thread.cpu) // All other threads, those of DDS too, are started from this one.
    {
        linux_extras::keep_calling_thread_off(*options.thread.cpu);
    }
    std::unique_ptr<Session> session(new Session(options));
    if (options.transport == TransportKind::dds)
    {
        auto client =
            dds::DdsClient::create(options.domain, fmt::format("hrtc-{}", getpid()), log_line);
        if (!client)
        {
            return failure(client.error().text);
        }
        session->client_ = std::move(client).value();
    }
    auto models = session->client_ != nullptr ? find_published(options, *session->client_)
                                              : find_in_files(options);
    if (!models)
    {
        return models.error();
    }
    auto controller = Controller::create(options, std::move(models).value(), log_line,
                                         [] { return !interrupted.load(); });
    if (!controller)
    {
        return failure(controller.error().text);
    }
    session->controller_ = std::move(controller).value();
    if (session->client_ != nullptr)
    {
        auto topics =
            HostTopics::create(*session->client_, *session->controller_, options.follows_poses);
        if (!topics)
        {
            return failure(topics.error().text);
        }
        session->topics_ = std::move(topics).value();
    }
    return session;
}

Result<FinishedRun, SessionError> Session::run(const std::string& what)
{
    const std::size_t tools = controller_->tools().size();
    const Duration period = options_.period();
    FinishedRun done{.statistics = RunStatistics(tools, tools * controller_->poses().size(),
                                                 controller_->models().size(), period),
                     .thread = {},
                     .timer = {},
                     .period = period,
                     .safety = SafetyRecord(tools),
                     .pose_uses = {},
                     .pose_counts = {},
                     .recording = {},
                     .recording_error = {}};
    const PosixClock clock;
    PosixPeriodicTimer timer;
    std::optional<BudgetGovernor> governor = make_governor(options_, *controller_);
    std::optional<Recorder> recorder;
    if (const auto error = start_recorder(options_, *controller_, recorder))
    {
        return failure(*error);
    }
    PoseDoor door(controller_->poses(), nanoseconds(controller_->setup().pose_age_max_ns));
    TelemetryTap telemetry(period);
    if (topics_ != nullptr)
    {
        topics_->connect(door, telemetry);
    }
    TransportThread transport(controller_->couriers(), controller_->models(), topics_.get());
    HapticLoop loop({&controller_->frame(), controller_->devices(), controller_->limits(),
                     controller_->conditioners(), controller_->poses(), &timer, &clock,
                     controller_->budgets(), governor ? &*governor : nullptr,
                     recorder ? &recorder->tap() : nullptr, options_.frames(),
                     &transport.hosts_gone(), topics_ != nullptr ? &door : nullptr,
                     topics_ != nullptr ? &telemetry : nullptr},
                    done.statistics);
    PosixPeriodicTimer alarm;
    Supervisor supervisor({controller_->devices(), &loop.heartbeat(), &clock, &alarm, period});
    auto supervising = RtThread::start(Supervisor::thread_beside(options_.thread),
                                       [&supervisor] { supervisor.run(); });
    if (!supervising)
    {
        return failure("supervisor: " + supervising.error().message);
    }
    const StopAtEnd stop_supervisor(supervisor);
    running_loop.store(&loop);
    auto thread =
        RtThread::start(options_.thread, [&] { run_loop(options_, loop, timer, period); });
    if (!thread)
    {
        running_loop.store(nullptr);
        return failure(thread.error().message);
    }
    wait_for_end(loop, options_.frames(), supervisor, done.safety, what);
    if (loop.has_failed())
    {
        finish_recording(recorder, done); // Up to the frame that failed.
        std::fflush(nullptr);
        std::_Exit(kExitFailed);
    }
    thread.value().join();
    running_loop.store(nullptr);
    supervisor.stop();
    supervising.value().join();
    take_events(loop, supervisor, done.safety);
    done.safety.finish(supervisor.brakes(), loop.safety_log().lost() + supervisor.log().lost());
    transport.stop();
    finish_recording(recorder, done);
    done.thread = thread.value().report();
    done.supervisor_fifo = supervising.value().report().fifo;
    done.timer = timer.counts();
    done.host_was_lost = transport.host_was_lost();
    note_topics(topics_.get(), door, done);
    for (const std::string& line : done.thread.refused)
    {
        log_line("without " + line);
    }
    return done;
}

} // namespace tactus::hrtc
