// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/session_run.hpp"

#include "host_tools/cli/progress.hpp"
#include "platform/hrtc/signals.hpp"
#include "platform/posix/service_notify.hpp"
#include "platform/system_call_trap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <thread>
#include <utility>
#include <vector>

namespace tactus::hrtc
{

namespace
{

/// How long before the deadline the loop wakes to rehearse its queries.
constexpr Duration kMarginMost = microseconds(100);
/// Between two looks at the loop.
constexpr std::chrono::milliseconds kLook{20};

FinishedRun empty_run(const Controller& controller, Duration period)
{
    const std::size_t tools = controller.tools().size();
    return {.statistics = RunStatistics(tools, controller.frame().objects().capacity(),
                                        controller.models().size(), period),
            .period = period,
            .started = std::time(nullptr),
            .safety = SafetyRecord(tools)};
}

/// None when the budgets are to stay as they are.
std::optional<BudgetGovernor> make_governor(const Options& options, const Controller& controller)
{
    if (!options.frame_budget_us)
    {
        return std::nullopt;
    }
    const auto budget_ns = static_cast<std::int64_t>(*options.frame_budget_us * 1e3);
    const std::uint32_t pairs = capacities_of(controller.setup()).pairs;
    // Each pair is walked to refine and to answer, until the frame has no more walks.
    const auto walks = 2 * std::min(pairs, kFrameWalks);
    return BudgetGovernor(nanoseconds(budget_ns), controller.budgets(), walks);
}

/// On the haptic thread; returns why the option can't be had.
std::optional<std::string> trap_calls(const Options& options)
{
    if (!options.trap_system_calls)
    {
        return std::nullopt;
    }
    const auto set = system_call_trap::set_on_this_thread();
    return set ? std::nullopt : std::optional("--trap-system-calls: " + set.error().text);
}

} // namespace

SessionRun::SessionRun(const RunParts& parts)
    : parts_(parts)
    , period_(parts.options.period())
    , done_(empty_run(parts.controller, period_))
    , governor_(make_governor(parts.options, parts.controller))
    , door_(parts.controller.poses(), parts.controller.frame().objects().capacity(),
            nanoseconds(parts.controller.setup().pose_age_max_ns))
    , telemetry_(period_)
    , transport_(parts.controller.courier(), parts.controller.models(), connected_topics())
    , loop_(loop_parts(), done_.statistics)
    , devices_gone_(parts.controller.tools().size())
    , supervisor_({parts.controller.tools(), &loop_.heartbeat(), &clock_, &alarm_, period_})
{
}

/// Of a run that was left before its end: the supervisor watches until the loop has ended.
SessionRun::~SessionRun()
{
    loop_.stop();
    haptic_thread_.reset();
    supervisor_.stop();
}

HostTopics* SessionRun::connected_topics()
{
    if (parts_.topics != nullptr)
    {
        parts_.topics->connect(door_, telemetry_, clock_.now());
    }
    return parts_.topics;
}

LoopParts SessionRun::loop_parts()
{
    Controller& controller = parts_.controller;
    const bool has_topics = parts_.topics != nullptr;
    return {.frame = &controller.frame(),
            .tools = controller.tools(),
            .timer = &timer_,
            .clock = &clock_,
            .budgets = controller.budgets(),
            .governor = governor_ ? &*governor_ : nullptr,
            .tap = parts_.recorder != nullptr ? &parts_.recorder->tap() : nullptr,
            .frames = parts_.options.frames(),
            .hosts_gone = &transport_.hosts_gone(),
            .pose_door = has_topics ? &door_ : nullptr,
            .telemetry = has_topics ? &telemetry_ : nullptr};
}

std::optional<Refusal> SessionRun::start()
{
    brake_.emplace(loop_);
    auto supervising = RtThread::start(Supervisor::thread_beside(parts_.options.thread),
                                       [this] { supervisor_.run(); });
    if (!supervising)
    {
        return failure("supervisor: " + supervising.error().text);
    }
    supervisor_thread_ = std::move(supervising).value();
    auto haptic = RtThread::start(parts_.options.thread, [this] { run_loop(); });
    if (!haptic)
    {
        return failure(haptic.error().text);
    }
    haptic_thread_ = std::move(haptic).value();
    return std::nullopt;
}

/// The haptic thread's body.
void SessionRun::run_loop()
{
    if (const auto error = trap_calls(parts_.options))
    {
        log_line(*error);
        loop_.fail();
        return;
    }
    const Duration margin = std::min(kMarginMost, {period_.ns / 5});
    if (const auto started = timer_.start(period_, margin); !started)
    {
        log_line(started.error().text);
        loop_.fail();
        return;
    }
    loop_.run();
}

void SessionRun::wait(const std::string& what)
{
    watch(what);
    end_after_failure();
}

void SessionRun::watch(const std::string& what)
{
    Progress progress(what, "frames");
    ServiceNotify manager;
    manager.ready();
    std::uint64_t seen = 0;
    while (!loop_.is_done() && !loop_.has_failed())
    {
        if (was_interrupted())
        {
            loop_.stop();
        }
        const std::uint64_t done = loop_.frames_done();
        if (done > seen)
        {
            manager.alive(clock_.now());
        }
        seen = done;
        progress.update(done, parts_.options.frames());
        take_events();
        std::this_thread::sleep_for(kLook);
    }
    manager.stopping();
}

/// What loop and supervisor have noted since the last time.
void SessionRun::take_events()
{
    std::vector<SafetyEvent> events;
    loop_.safety_log().take_into(events);
    supervisor_.log().take_into(events);
    for (const SafetyEvent& event : events)
    {
        done_.safety.add(event);
        tell_of_device(event);
    }
}

/// A line when a tool's device goes, and when it is back.
void SessionRun::tell_of_device(const SafetyEvent& event)
{
    const bool is_gone = has_cause(event.causes, ForceOff::disconnect);
    if (event.by_supervisor || is_gone == devices_gone_[event.tool])
    {
        return;
    }
    devices_gone_[event.tool] = is_gone;
    const std::string& name = parts_.controller.tools()[event.tool].device->info().name;
    device_log_.write(is_gone
                          ? fmt::format("tool {}: its device, {}, is gone; no force until it is "
                                        "back",
                                        event.tool, name)
                          : fmt::format("tool {}: its device, {}, is back", event.tool, name));
}

/// No effect when nothing has failed.
void SessionRun::end_after_failure()
{
    if (loop_.has_failed() || AssertionBrake::has_failed())
    {
        finish_recording(); // Up to the frame that failed.
        std::fflush(nullptr);
        AssertionBrake::end_process();
    }
}

FinishedRun SessionRun::finish()
{
    haptic_thread_->join();
    brake_.reset();
    supervisor_.stop();
    supervisor_thread_->join();
    take_events();
    done_.safety.finish(supervisor_.brakes(), loop_.safety_log().lost() + supervisor_.log().lost());
    transport_.stop();
    finish_recording();
    done_.thread = haptic_thread_->report();
    done_.supervisor_fifo = supervisor_thread_->report().fifo;
    done_.timer = timer_.counts();
    done_.host_was_lost = transport_.host_was_lost();
    note_topics();
    for (const std::string& line : done_.thread.refused)
    {
        log_line("without " + line);
    }
    return std::move(done_);
}

/// After a run that ended well or not; a refusal is logged.
void SessionRun::finish_recording()
{
    if (parts_.recorder == nullptr)
    {
        return;
    }
    const auto recording = parts_.recorder->finish();
    if (!recording)
    {
        done_.recording_error = recording.error().text;
        log_line("--record: " + *done_.recording_error);
        return;
    }
    done_.recording = recording.value();
}

/// What hosts and controller told each other; the threads between which it went have ended.
void SessionRun::note_topics()
{
    if (parts_.topics != nullptr)
    {
        done_.pose_uses.assign(door_.uses().begin(), door_.uses().end());
        done_.pose_counts = parts_.topics->pose_counts();
        done_.scene_news = parts_.topics->scene_news();
        done_.refused = parts_.topics->refused();
        done_.telemetry_sent = parts_.topics->telemetry_sent();
    }
}

} // namespace tactus::hrtc
