// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/session_run.hpp"

#include "platform/choices/run_options.hpp"
#include "platform/controller/controller.hpp"
#include "platform/controller/failed_run.hpp"
#include "platform/controller/guardian.hpp"
#include "platform/controller/recorder.hpp"
#include "platform/controller/server_topics.hpp"
#include "platform/controller/trace_file.hpp"
#include "platform/devices/udp/udp_device.hpp"
#include "platform/loop/hand_tap.hpp"
#include "platform/loop/machine.hpp"
#include "platform/machine/allocation_counter.hpp"
#include "platform/machine/posix/service_notify.hpp"
#include "platform/machine/system_call_trap.hpp"
#include "platform/scene/program_scene.hpp"
#include "rt_core/scene/object_table.hpp"
#include "transport/base/number_form.hpp"
#include "transport/inside_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <ctime>
#include <limits>
#include <numeric>
#include <thread>
#include <utility>

namespace tactus::hrtc
{

namespace
{

/// Longest time before the deadline at which the loop wakes to warm its caches.
constexpr Duration kMarginMost = microseconds(100);
/// Pause between two looks of the main thread at the loop.
constexpr std::chrono::milliseconds kLook{20};
/// Distance of a device from its workspace's centre, in radii of the workspace, above which its
/// unit of length is doubted.
constexpr double kFarOutside = 5.0;
/// Number of datagrams with another device's description, since the last accepted datagram, that
/// ends the run. A waiting driver sends as many in half a second.
constexpr std::uint64_t kOthersMax = 5;

FinishedRun empty_run(const Controller& controller, const Options& options)
{
    const Duration period = options.period();
    const std::size_t tools = controller.tools().size();
    return {.statistics = RunStatistics(tools, controller.object_table().capacity(),
                                        controller.models().size(), period),
            .supervisor_periods =
                options.supervisor_periods.value_or(silent_periods(describe_machine())),
            .period = period,
            .started = std::time(nullptr),
            .safety = SafetyRecord(tools)};
}

/// Finishes a file of a complete or failed run; null if there is none. Logs a refusal.
template <typename File, typename FileResult>
void finish_file(const std::string& option, File* file, std::optional<FileResult>& result,
                 std::optional<std::string>& error)
{
    if (file == nullptr)
    {
        return;
    }
    const auto finished = file->finish();
    if (!finished)
    {
        error = finished.error().text;
        log_error(option + ": " + *error);
        return;
    }
    result = finished.value();
}

/// Budget governor; none in virtual time, where frames take no time.
std::optional<BudgetGovernor> make_governor(const Options& options)
{
    if (options.virtual_time)
    {
        return std::nullopt;
    }
    return BudgetGovernor(options.frame_budget(), Budgets::least_work(options.work_times()),
                          options.frame_work());
}

/// True if `place_m`, in the model's frame, is in the model's box.
bool is_in_box(const ModelHeader& header, const Vec3& place_m)
{
    const auto& extent = header.fields().extent_quanta;
    const Vec3 high_m =
        static_cast<double>(header.quantum_m()) * Vec3(extent[0], extent[1], extent[2]);
    return place_m.minCoeff() >= 0.0 && (high_m - place_m).minCoeff() >= 0.0;
}

/// Traps system calls on the calling thread if requested. Returns the reason if that fails.
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
    , done_(empty_run(parts.controller, parts.options))
    , time_(parts.options.virtual_time)
    , governor_(make_governor(parts.options))
    , mailbox_(parts.controller.poses(), parts.controller.object_table().capacity(),
               nanoseconds(parts.controller.setup().pose_age_max_ns),
               parts.options.object_speed_m_per_s)
    , telemetry_(period_)
    , transport_(parts.controller.chunk_loader(), parts.controller.models(), connected_topics(),
                 parts.trace != nullptr ? &parts.trace->tap() : nullptr, connected_program())
    , loop_(loop_parts(), done_.statistics)
    , devices_gone_(parts.controller.tools().size())
    , datagrams_reported_(parts.controller.tools().size())
    , supervisor_({.tools = parts.controller.tools(),
                   .heartbeat = &loop_.heartbeat(),
                   .clock = &time_.clock(),
                   .timer = &alarm_,
                   .period = period_,
                   .silent_periods = done_.supervisor_periods})
{
    if (time_.is_virtual())
    {
        time_.set_meanwhile([this] { work_between_frames(); });
    }
    else
    {
        transport_thread_.emplace(transport_);
    }
}

/// If the run was left early, the supervisor still watches until the loop has ended.
SessionRun::~SessionRun()
{
    loop_.stop();
    haptic_thread_.reset();
    supervisor_.stop();
}

ServerTopics* SessionRun::connected_topics()
{
    if (parts_.topics != nullptr)
    {
        SceneKeeper::NameSink names;
        if (Recorder* const recorder = parts_.recorder; recorder != nullptr)
        {
            names =
                [recorder](std::uint32_t number, std::uint32_t generation, const std::string& name)
            { recorder->name_object(number, generation, name); };
        }
        parts_.topics->connect(mailbox_, make_edit_mailbox(), telemetry_, make_refinement_state(),
                               time_.clock().now(), std::move(names));
    }
    return parts_.topics;
}

ProgramScene* SessionRun::connected_program()
{
    if (parts_.program != nullptr)
    {
        parts_.program->connect(mailbox_);
    }
    return parts_.program;
}

/// Mailbox of servers' edits; null if no server edits a model.
EditMailbox* SessionRun::make_edit_mailbox()
{
    if (parts_.topics->has_edits())
    {
        edit_mailbox_ = std::make_unique<EditMailbox>();
    }
    return edit_mailbox_.get();
}

/// Tap of the refinement state; null if no viewer gets it.
RefinementStateTap* SessionRun::make_refinement_state()
{
    if (parts_.topics->shows_refinement_state())
    {
        refinement_state_.emplace(parts_.controller.page_pool());
    }
    return refinement_state_ ? &*refinement_state_ : nullptr;
}

LoopParts SessionRun::loop_parts()
{
    Controller& controller = parts_.controller;
    const bool has_topics = parts_.topics != nullptr;
    const Options& options = parts_.options;
    if (parts_.recorder == nullptr && !options.is_stepped)
    {
        last_inputs_.emplace(controller.tools().size());
    }
    return {.frame = &controller.frame(),
            .tools = controller.tools(),
            .timer = &time_.timer(),
            .clock = &time_.clock(),
            .budgets = controller.budgets(),
            .governor = governor_ ? &*governor_ : nullptr,
            .tap = parts_.recorder != nullptr ? &parts_.recorder->tap() : nullptr,
            .last_inputs = last_inputs_ ? &*last_inputs_ : nullptr,
            .frames = options.runs_until_stopped ? std::numeric_limits<std::uint64_t>::max()
                                                 : options.frames(),
            .is_virtual = time_.is_virtual(),
            .servers_gone = &transport_.servers_gone(),
            .starved = &transport_.starved(),
            .scene_mailbox = has_topics || parts_.program != nullptr ? &mailbox_ : nullptr,
            .edit_mailbox = edit_mailbox_ != nullptr ? edit_mailbox_.get() : parts_.edits.mailbox,
            .telemetry = has_topics ? &telemetry_ : nullptr,
            .refinement_state = refinement_state_ ? &*refinement_state_ : nullptr,
            .trace = parts_.trace != nullptr ? &parts_.trace->tap() : nullptr,
            .hands = parts_.hands,
            .cuts = edit_mailbox_ != nullptr ? parts_.topics->cut_tap() : parts_.edits.cuts};
}

std::optional<Refusal> SessionRun::start()
{
    if (parts_.options.is_stepped)
    {
        if (const auto started = time_.timer().start(period_, Duration{}); !started)
        {
            return started.error();
        }
        loop_.begin();
        return std::nullopt;
    }
    brake_.emplace(loop_);
    if (!time_.is_virtual())
    {
        if (auto error = start_supervisor())
        {
            return error;
        }
    }
    auto haptic = RtThread::start(parts_.options.thread, [this] { run_loop(); });
    if (!haptic)
    {
        return failure(haptic.error().text);
    }
    haptic_thread_ = std::move(haptic).value();
    return std::nullopt;
}

void SessionRun::step(std::uint32_t periods)
{
    for (std::uint32_t i = 1; i < periods; ++i)
    {
        loop_.skip_period();
    }
    loop_.step();
}

std::optional<Refusal> SessionRun::start_supervisor()
{
    auto supervising = RtThread::start(Supervisor::thread_beside(parts_.options.thread),
                                       [this] { supervisor_.run(); });
    if (!supervising)
    {
        return failure("supervisor: " + supervising.error().text);
    }
    supervisor_thread_ = std::move(supervising).value();
    return std::nullopt;
}

/// Does one period's work of the other threads in virtual time: as many transport rounds as their
/// thread would do. Haptic thread.
void SessionRun::work_between_frames()
{
    allocation_counter::mark_this_thread(false);
    const MonotonicTime now = time_.clock().now();
    for (Duration since{}; since < period_; since = since + kRoundPause)
    {
        transport_.run(now);
    }
    if (parts_.recorder != nullptr)
    {
        parts_.recorder->step();
    }
    take_events();
    allocation_counter::mark_this_thread(true);
}

/// Body of the haptic thread.
void SessionRun::run_loop()
{
    if (const auto error = trap_calls(parts_.options))
    {
        log_error(*error);
        loop_.fail();
        return;
    }
    const Duration margin = std::min(kMarginMost, {period_.ns / 5});
    if (const auto started = time_.timer().start(period_, margin); !started)
    {
        log_error(started.error().text);
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
    const RunHooks& hooks = parts_.hooks;
    const FramesDone progress = hooks.begin_progress ? hooks.begin_progress(what) : FramesDone();
    std::optional<ServiceNotify> manager;
    if (hooks.notifies_manager)
    {
        manager.emplace().ready();
    }
    std::uint64_t seen = 0;
    while (!loop_.is_done() && !loop_.has_failed())
    {
        if (!hooks.goes_on())
        {
            loop_.stop();
        }
        const std::uint64_t done = loop_.frames_done();
        if (done > seen && manager)
        {
            manager->alive(PosixClock().now());
        }
        seen = done;
        if (progress)
        {
            progress(done, parts_.options.frames());
        }
        if (!time_.is_virtual())
        {
            take_events();
            report_refused_datagrams();
            report_guardian();
        }
        std::this_thread::sleep_for(kLook);
    }
    if (manager)
    {
        manager->stopping();
    }
}

/// Adds the new events of the loop and the supervisor to the safety record, and logs them.
void SessionRun::take_events()
{
    std::vector<SafetyEvent> events;
    loop_.safety_log().take_into(events);
    supervisor_.log().take_into(events);
    for (const SafetyEvent& event : events)
    {
        done_.safety.add(event);
        report_device(event);
    }
    if (parts_.hands != nullptr)
    {
        parts_.hands->note_brakes(supervisor_.brakes());
    }
    report_first_places();
}

/// Logs, once, the tools whose first position is far outside the workspace or inside an object.
void SessionRun::report_first_places()
{
    const std::span<const Vec3> places_m = loop_.first_places_m();
    if (places_m.empty() || !done_.begins_inside.empty())
    {
        return;
    }
    done_.begins_inside.resize(places_m.size());
    for (std::size_t tool = 0; tool < places_m.size(); ++tool)
    {
        const DeviceInfo& device = parts_.controller.tools()[tool].device->info();
        const auto& centre_m = device.workspace_centre_world_m;
        const double away_m = (places_m[tool] - Vec3(centre_m[0], centre_m[1], centre_m[2])).norm();
        if (away_m > kFarOutside * device.workspace_radius_m)
        {
            log_line(fmt::format("tool {}: the device is {:.3g} m from the centre of its workspace "
                                 "with a radius of {:.3g} m; does it send metres?",
                                 tool, away_m, device.workspace_radius_m));
        }
    }
    report_insides(places_m);
}

/// Logs and notes the tools that begin inside a closed object. Objects are at their first poses.
void SessionRun::report_insides(std::span<const Vec3> places_m)
{
    const Controller& controller = parts_.controller;
    for (std::size_t object = 0; object < controller.objects().size(); ++object)
    {
        const ServedModel& model = controller.models()[controller.objects()[object].model.value];
        const ModelHeader header = ModelHeader::parse(model.header).value();
        const ObjectPose pose = model_pose(controller.poses()[object], header.origin_m());
        const auto is_near = [&](const Vec3& place_m)
        { return is_in_box(header, to_model(pose, place_m)); };
        if (std::ranges::none_of(places_m, is_near)) // A scene may have thousands of objects.
        {
            continue;
        }
        const InsideTest inside(header, model.base);
        for (std::size_t tool = 0; tool < places_m.size(); ++tool)
        {
            if (inside.holds(to_model(pose, places_m[tool])))
            {
                done_.begins_inside[tool] = model.name;
                if (parts_.hands != nullptr)
                {
                    parts_.hands->note_begins_inside(tool);
                }
                if (parts_.topics != nullptr)
                {
                    parts_.topics->tell_begins_inside(tool);
                }
                log_line(fmt::format("tool {} begins inside {}, a closed surface, which keeps it "
                                     "inside and pulls the hand back; begin outside",
                                     tool, model.name));
            }
        }
    }
}

/// Logs the loss and the return of a tool's device.
void SessionRun::report_device(const SafetyEvent& event)
{
    const bool is_gone = has_cause(event.causes, ForceOff::disconnect);
    if (event.by_supervisor || is_gone == devices_gone_[event.tool])
    {
        return;
    }
    devices_gone_[event.tool] = is_gone;
    const std::string& name = parts_.controller.tools()[event.tool].device->info().name;
    device_log_.write(
        is_gone
            ? fmt::format(
                  "tool {}: the device {} is disconnected; no force until it is connected again",
                  event.tool, name)
            : fmt::format("tool {}: the device {} is connected again", event.tool, name));
}

/// Logs refused datagrams to a UDP device's port at the first one, at ten, at a hundred, and so on.
/// Ends the run if another device describes itself at the port.
void SessionRun::report_refused_datagrams()
{
    for (std::size_t tool = 0; tool < datagrams_reported_.size(); ++tool)
    {
        const auto* udp =
            dynamic_cast<const UdpDevice*>(parts_.controller.tools()[tool].device.get());
        if (udp == nullptr)
        {
            continue;
        }
        const UdpTraffic traffic = udp->traffic();
        const auto& refused = traffic.refused;
        if (traffic.others >= kOthersMax && !std::exchange(done_.has_other_device, true))
        {
            loop_.stop();
            device_log_.write(fmt::format(
                "tool {}: the device {} is disconnected, and another device describes itself at "
                "its port; the run ends, because it keeps the limits of its first device",
                tool, udp->info().name));
        }
        const auto all = std::accumulate(refused.begin(), refused.end(), std::uint64_t{0});
        if (all >= std::max<std::uint64_t>(10 * datagrams_reported_[tool], 1))
        {
            datagrams_reported_[tool] = all;
            const auto most = std::ranges::max_element(refused) - refused.begin();
            const auto fault = static_cast<udp::DatagramFault>(most);
            const bool has_value =
                fault == udp::DatagramFault::content && traffic.wrong_value != nullptr;
            device_log_.write(
                fmt::format("tool {}: {} to the port of the device refused, mostly: {}{}{}", tool,
                            counted(all, "datagram"), udp::text_of(fault), has_value ? ": " : "",
                            has_value ? traffic.wrong_value : ""));
        }
    }
}

/// Logs the guardian's death. The run goes on; forces still fade while this process lives.
void SessionRun::report_guardian()
{
    if (parts_.guardian != nullptr && parts_.guardian->has_died())
    {
        log_line("the guardian has ended; if hrtc is killed, nothing brakes its devices");
        parts_.guardian = nullptr;
    }
}

/// If an assertion or the loop has failed, ends the process; else does nothing.
void SessionRun::end_after_failure()
{
    if (loop_.has_failed() || AssertionBrake::has_failed())
    {
        const std::string advice = keep_failed_frame();
        finish_file("--trace", parts_.trace, done_.trace, done_.trace_error);
        std::fflush(nullptr);
        AssertionBrake::end_process(advice);
    }
}

/// Finishes the recording, with the failed frame if the haptic thread failed in one; without
/// --record writes the last inputs if the haptic thread failed. Returns advice on how to repeat the
/// failure, or why there is none; may be empty.
std::string SessionRun::keep_failed_frame()
{
    const bool is_frames = loop_.has_failed() && loop_.has_failed_itself();
    const std::optional<GivenFrame> failed = is_frames ? loop_.failed_frame() : std::nullopt;
    if (parts_.recorder != nullptr)
    {
        if (failed)
        {
            parts_.recorder->add_failed(*failed);
        }
        finish_file("--record", parts_.recorder, done_.recording, done_.recording_error);
        return failed && done_.recording && done_.recording->lost_from == kNoFrame
                   ? fmt::format("'hrtc --replay {}' repeats the failure",
                                 parts_.options.record_path)
                   : std::string();
    }
    if (!is_frames)
    {
        return {};
    }
    const auto kept = write_last_inputs(*last_inputs_, failed, parts_.controller.setup());
    if (!kept)
    {
        return kept.error().text;
    }
    return fmt::format("'--device replay:{}' repeats the motion of the last {}; only a run with "
                       "--record can be replayed exactly",
                       kept.value().path, counted(kept.value().frames, "frame"));
}

FinishedRun SessionRun::finish()
{
    if (haptic_thread_)
    {
        haptic_thread_->join();
    }
    else
    {
        loop_.rest();
    }
    done_.statistics.deadlines.compare_work();
    brake_.reset();
    supervisor_.stop();
    const bool is_supervised = supervisor_thread_.has_value();
    if (is_supervised)
    {
        supervisor_thread_->join();
    }
    take_events();
    done_.safety.finish(supervisor_.brakes(), loop_.safety_log().lost() + supervisor_.log().lost());
    transport_thread_.reset();
    finish_file("--record", parts_.recorder, done_.recording, done_.recording_error);
    finish_file("--trace", parts_.trace, done_.trace, done_.trace_error);
    done_.thread = haptic_thread_ ? haptic_thread_->report() : RtThreadReport{};
    done_.supervisor_fifo = is_supervised && supervisor_thread_->report().fifo;
    done_.timer = time_.timer().counts();
    done_.server_was_lost = transport_.server_was_lost();
    note_topics();
    for (const std::string& line : done_.thread.refused)
    {
        log_line("ran without a right: " + line);
    }
    return std::move(done_);
}

/// Copies the results of the topics into done_. The threads that use them must have ended.
void SessionRun::note_topics()
{
    if (parts_.topics != nullptr)
    {
        done_.pose_uses.assign(mailbox_.uses().begin(), mailbox_.uses().end());
        done_.pose_counts = parts_.topics->pose_counts();
        done_.scene_news = parts_.topics->scene_news();
        done_.edit_counts = parts_.topics->edit_counts();
        done_.cuts = parts_.topics->cut_counts();
        done_.refused = parts_.topics->refused();
        done_.server_events = parts_.topics->server_events();
        done_.telemetry_sent = parts_.topics->telemetry_sent();
        done_.states_sent = parts_.topics->states_sent();
    }
}

} // namespace tactus::hrtc
