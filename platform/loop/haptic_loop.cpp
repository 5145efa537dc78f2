// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/loop/haptic_loop.hpp"

#include "platform/loop/budget_governor.hpp"
#include "platform/loop/cut_tap.hpp"
#include "platform/loop/edit_mailbox.hpp"
#include "platform/loop/hand_tap.hpp"
#include "platform/loop/model_marks.hpp"
#include "platform/loop/refinement_state_tap.hpp"
#include "platform/loop/scene_mailbox.hpp"
#include "platform/loop/telemetry_tap.hpp"
#include "platform/loop/trace_tap.hpp"
#include "platform/machine/allocation_counter.hpp"
#include "platform/machine/clock.hpp"
#include "platform/machine/periodic_timer.hpp"
#include "platform/machine/system_call_trap.hpp"
#include "platform/recording/frame_tap.hpp"
#include "platform/recording/last_inputs.hpp"
#include "rt_core/frame/frame.hpp"
#include "rt_core/frame/list_touches.hpp"
#include "rt_core/limits.hpp"

#include <algorithm>
#include <utility>

namespace tactus::hrtc
{

HapticLoop::HapticLoop(const LoopParts& parts, RunStatistics& statistics)
    : parts_(parts)
    , statistics_(statistics)
    , states_(parts.tools.size())
    , forces_(parts.tools.size())
    , first_places_m_(parts.tools.size())
    , devices_(parts.tools.size())
    , end_(parts.frames)
{
    for (const ToolSetup& tool : parts.tools)
    {
        ports_.emplace_back(tool);
        radii_m_.push_back(tool.spec.radius_m);
    }
    measures_.budgets = parts.budgets;
}

void HapticLoop::run() noexcept
{
    begin();
    while (!has_to_end())
    {
        step();
    }
    rest();
}

void HapticLoop::begin() noexcept
{
    allocation_counter::mark_this_thread(true);
    haptic_thread_.store(std::this_thread::get_id());
    fade_frames_ = static_cast<std::uint64_t>(kFadeTime_s / to_seconds(parts_.timer->period())) + 1;
    usage_ = thread_usage();
    allocations_ = allocation_counter::of_this_thread().allocations;
    last_end_ = parts_.clock->now();
}

void HapticLoop::step() noexcept
{
    wait_for_deadline();
    run_period();
    ++frame_;
    frames_done_.store(frame_, std::memory_order_relaxed);
}

void HapticLoop::skip_period() noexcept
{
    parts_.timer->sleep_until_margin();
    skipped_periods_ += parts_.timer->spin_until_deadline().periods;
}

void HapticLoop::rest() noexcept
{
    heartbeat_.rest();
    for (ToolPort& port : ports_)
    {
        port.rest();
    }
    allocation_counter::mark_this_thread(false);
    done_.store(true);
}

void HapticLoop::run_period() noexcept
{
    const Duration cpu_before = cpu_time();
    const MonotonicTime start = parts_.clock->now();
    heartbeat_.beat(start);
    stage_start_ = start;
    read_devices();
    const FrameInput input = read_scene(start);
    measures_.outside = parts_.clock->now() - start;
    const FrameOutput output = run_frame(input);
    const MonotonicTime answered = parts_.clock->now();
    make_safe(output);
    write_devices();
    last_end_ = parts_.clock->now();
    measures_.outside += last_end_ - answered;
    const ThreadUsage now = thread_usage();
    record(input, output);
    if (parts_.edit_mailbox != nullptr)
    {
        parts_.edit_mailbox->done(output.models);
    }
    measures_.frame = last_end_ - start;
    measures_.cpu = now.cpu_time - cpu_before;
    measures_.lateness_of_end = last_end_ - measures_.cycle.deadline;
    measure_thread(now);
    statistics_.add(output, forces_, measures_);
    show(output, start);
    trace(output, start);
    choose_budgets(output);
}

ThreadUsage HapticLoop::thread_usage() const noexcept
{
    return parts_.is_virtual ? ThreadUsage{} : read_thread_usage();
}

Duration HapticLoop::cpu_time() const noexcept
{
    return parts_.is_virtual ? Duration{} : read_thread_cpu_time();
}

/// Measures the thread's usage since the last cycle. The system is asked about a stop of the
/// process only if the thread slept unexpectedly or was late.
void HapticLoop::measure_thread(const ThreadUsage& now) noexcept
{
    measures_.usage = now - usage_;
    measures_.usage.voluntary_switches -= timer_switches_;
    usage_ = now;
    const bool looks_stopped = measures_.usage.voluntary_switches > 0 ||
                               measures_.cycle.periods > 1 ||
                               measures_.lateness_of_end > parts_.timer->period();
    measures_.was_stopped = !parts_.is_virtual && looks_stopped && take_process_stop();
    measures_.allocations = allocation_counter::of_this_thread().allocations - allocations_;
    allocations_ += measures_.allocations;
    measures_.calls = system_call_trap::of_this_thread();
}

/// After stop() the run ends as soon as the forces had the time to fade.
bool HapticLoop::has_to_end() noexcept
{
    if (stopped_.load(std::memory_order_relaxed))
    {
        end_ = std::min(end_, frame_ + fade_frames_); // Only the first call after stop() lowers it.
    }
    return frame_ >= end_ || failing_.load();
}

void HapticLoop::wait_for_deadline() noexcept
{
    measures_.beside = parts_.clock->now() - last_end_;
    const ThreadUsage asleep = thread_usage();
    parts_.timer->sleep_until_margin();
    const ThreadUsage awake = thread_usage();
    const MonotonicTime awake_at = parts_.clock->now();
    if (!parts_.is_virtual) // There is no wait in which caches could grow cold.
    {
        warm_caches();
    }
    measures_.beside += parts_.clock->now() - awake_at;
    const ThreadUsage ready = thread_usage();
    measures_.cycle = parts_.timer->spin_until_deadline();
    measures_.cycle.periods += std::exchange(skipped_periods_, 0);
    measures_.beside_cpu = asleep.cpu_time - usage_.cpu_time + (ready.cpu_time - awake.cpu_time);
    timer_switches_ = awake.voluntary_switches - asleep.voluntary_switches;
    if (measures_.cycle.periods > 1) // The timer sleeps once more only after a stall.
    {
        timer_switches_ += thread_usage().voluntary_switches - ready.voluntary_switches;
    }
}

/// Warms the caches, with system calls trapped as in the frame: neither may make one.
void HapticLoop::warm_caches() noexcept
{
    system_call_trap::mark_frame(true);
    parts_.frame->warm_caches();
    system_call_trap::mark_frame(false);
}

FrameOutput HapticLoop::run_frame(const FrameInput& input) noexcept
{
    given_ = input;
    is_recorded_ = false;
    system_call_trap::mark_frame(true);
    const FrameOutput output = parts_.frame->run(input, {&mark_stage, this});
    system_call_trap::mark_frame(false);
    return output;
}

/// Records the frame's inputs. Called after the forces are written and the frame's time is taken.
void HapticLoop::record(const FrameInput& input, const FrameOutput& output) noexcept
{
    if (parts_.tap != nullptr)
    {
        parts_.tap->record(input, output, devices_);
    }
    if (parts_.last_inputs != nullptr)
    {
        parts_.last_inputs->keep(input, devices_);
    }
    is_recorded_ = true;
}

void HapticLoop::trace(const FrameOutput& output, MonotonicTime start) noexcept
{
    if (parts_.trace == nullptr)
    {
        return;
    }
    TracedFrame traced{.frame = frame_,
                       .deadline = measures_.cycle.deadline,
                       .start = start,
                       .end = last_end_,
                       .stage = measures_.stage,
                       .wake_lateness = measures_.cycle.wake_lateness,
                       .periods = measures_.cycle.periods,
                       .requests = output.work.requests,
                       .splits = output.work.splits,
                       .merges = output.work.merges,
                       .triangles = output.work.triangles_tested,
                       .faults = output.faults};
    for (const QueueEvent& event : output.queues.events)
    {
        ++(event.kind == QueueEventKind::arrival ? traced.arrivals : traced.link_updates);
    }
    for (const ToolOutput& tool : output.tools)
    {
        traced.in_contact = traced.in_contact || tool.in_contact;
    }
    parts_.trace->add(traced);
}

/// Chooses the next frame's work budget between frames, so that the frame takes it as an input like
/// any other.
void HapticLoop::choose_budgets(const FrameOutput& output) noexcept
{
    if (parts_.governor != nullptr)
    {
        parts_.governor->observe({measures_.frame, output.work.budget.used()});
        measures_.budgets.work = parts_.governor->work();
        measures_.is_work_at_floor = parts_.governor->is_at_floor();
    }
}

void HapticLoop::fail() noexcept
{
    // A second failure, during the fade, brakes at once.
    const bool is_first = !failing_.exchange(true);
    if (is_first && haptic_thread_.load() == std::this_thread::get_id())
    {
        has_failed_itself_ = true;
        fade_last_forces();
    }
    for (ToolPort& port : ports_)
    {
        port.brake();
    }
    failed_.store(true);
}

std::optional<GivenFrame> HapticLoop::failed_frame() noexcept
{
    if (!has_failed_itself_ || is_recorded_)
    {
        return std::nullopt;
    }
    for (std::size_t i = 0; i < ports_.size(); ++i)
    {
        devices_[i] = ports_[i].record();
    }
    return GivenFrame{given_, parts_.frame->pools().cache.taken(), devices_};
}

/// Fades all forces on the haptic thread. The frame that was interrupted can't be trusted, so only
/// the forces sent last are used.
void HapticLoop::fade_last_forces() noexcept
{
    for (std::size_t i = 0; i < ports_.size(); ++i)
    {
        note(i, SafetyState::brake, ForceOff::assertion);
    }
    const double period_s = to_seconds(parts_.timer->period());
    for (std::uint64_t left = fade_frames_; left > 0; --left)
    {
        for (ToolPort& port : ports_)
        {
            port.fade(period_s, ForceOff::assertion);
        }
        heartbeat_.beat(parts_.clock->now());
        parts_.timer->sleep_until_margin();
        static_cast<void>(parts_.timer->spin_until_deadline());
    }
    heartbeat_.rest();
}

void HapticLoop::read_devices() noexcept
{
    for (std::size_t i = 0; i < ports_.size(); ++i)
    {
        states_[i] = ports_[i].read(measures_.cycle.periods);
    }
    if (!has_places_.load(std::memory_order_relaxed)) // No other thread writes it.
    {
        note_first_places();
    }
}

void HapticLoop::note_first_places() noexcept
{
    if (std::ranges::all_of(states_, &ToolState::valid))
    {
        std::ranges::transform(states_, first_places_m_.begin(), &ToolState::position_m);
        // Pairs with the acquire in first_places_m().
        has_places_.store(true, std::memory_order_release);
    }
}

std::span<const Vec3> HapticLoop::first_places_m() const noexcept
{
    return has_places_.load(std::memory_order_acquire) ? std::span<const Vec3>(first_places_m_)
                                                       : std::span<const Vec3>();
}

/// Input of the frame. Network data on objects and models enters the frame here and nowhere else.
FrameInput HapticLoop::read_scene(MonotonicTime now) noexcept
{
    FrameInput input{states_, {}, measures_.budgets, now.ns, {}};
    if (parts_.scene_mailbox != nullptr)
    {
        input.changes = parts_.scene_mailbox->refresh(now, touches_.view());
    }
    if (parts_.edit_mailbox != nullptr)
    {
        input.edits = parts_.edit_mailbox->edits();
    }
    return input;
}

void HapticLoop::show(const FrameOutput& output, MonotonicTime start) noexcept
{
    if (parts_.telemetry != nullptr)
    {
        parts_.telemetry->show(
            {start, states_, devices_, radii_m_, output, parts_.frame->objects()}, statistics_);
    }
    if (parts_.refinement_state != nullptr)
    {
        parts_.refinement_state->show({frame_, parts_.frame->regions(), forces_, measures_.budgets},
                                      statistics_);
    }
    if (parts_.cuts != nullptr)
    {
        parts_.cuts->show({start.ns, output, forces_, radii_m_, parts_.frame->objects()});
    }
    if (parts_.hands != nullptr)
    {
        const DeadlineAccount& deadlines = statistics_.deadlines;
        parts_.hands->show(
            {frame_,
             states_,
             devices_,
             forces_,
             radii_m_,
             output,
             {frame_ + 1, deadlines.missed, deadlines.overruns, deadlines.latency_misses}});
    }
}

void HapticLoop::make_safe(const FrameOutput& output) noexcept
{
    PeriodContext context;
    context.elapsed_s = to_seconds(parts_.timer->period()) *
                        static_cast<double>(std::max(measures_.cycle.periods, 1U));
    const ForceOff for_all = causes_for_all(output);
    for (std::uint32_t i = 0; i < ports_.size(); ++i)
    {
        context.causes = for_all;
        if (touches_old_pose(i, output))
        {
            context.causes |= ForceOff::stale;
        }
        context.causes |= meets_what_outruns(i) ? ForceOff::jump : ForceOff::none;
        context.causes |= starves(i, output) ? ForceOff::starved : ForceOff::none;
        context.surface_damping_n_s_per_m = damping_touched(i, output);
        forces_[i] = ports_[i].make_safe(output.tools[i], context);
        devices_[i] = ports_[i].record();
        if (forces_[i].has_changed)
        {
            note(i, forces_[i].state, forces_[i].causes);
        }
    }
    if (parts_.scene_mailbox != nullptr) // The next refresh() of the mailbox needs the touches.
    {
        list_touches(*parts_.frame, output.pairs, parts_.scene_mailbox->belief(), touches_);
    }
}

bool HapticLoop::may_touch(const PairOutput& pair, const FrameOutput& output) const noexcept
{
    return tactus::may_touch(pair, output.tools[pair.tool], radii_m_[pair.tool]);
}

/// True if the tool may touch an object whose server's poses outran the object speed limit
/// (SceneMailbox::exceeds_limit()).
bool HapticLoop::meets_what_outruns(std::uint32_t tool) const noexcept
{
    return std::ranges::any_of(touches_,
                               [&](const ObjectTouch& touch)
                               {
                                   return touch.tool == tool && touch.is_in_reach &&
                                          parts_.scene_mailbox->exceeds_limit(touch.object);
                               });
}

/// True if the tool is data-limited or halted near a starved model.
bool HapticLoop::starves(std::uint32_t tool, const FrameOutput& output) const noexcept
{
    if (parts_.starved == nullptr ||
        !(output.tools[tool].data_limited || output.tools[tool].halted))
    {
        return false;
    }
    return std::ranges::any_of(output.pairs,
                               [&](const PairOutput& pair)
                               {
                                   const ModelId model =
                                       parts_.frame->objects()[pair.object].spec.model;
                                   return pair.tool == tool && is_in_reach(pair, radii_m_[tool]) &&
                                          parts_.starved->has(model.value);
                               });
}

/// Largest material damping of all objects that the tool may touch, in N s/m; 0 without one.
double HapticLoop::damping_touched(std::uint32_t tool, const FrameOutput& output) const noexcept
{
    double damping_n_s_per_m = 0.0;
    for (const PairOutput& pair : output.pairs)
    {
        if (pair.tool == tool && may_touch(pair, output))
        {
            damping_n_s_per_m = std::max(damping_n_s_per_m, pair.damping_n_s_per_m);
        }
    }
    return damping_n_s_per_m;
}

ForceOff HapticLoop::causes_for_all(const FrameOutput& output) const noexcept
{
    const ForceOff ends = frame_ + fade_frames_ >= end_ ? ForceOff::software : ForceOff::none;
    return ends | (lacks_a_server(output) ? ForceOff::server : ForceOff::none);
}

/// True if the tool is in contact and one of its answers uses a pose that is too old.
bool HapticLoop::touches_old_pose(std::uint32_t tool, const FrameOutput& output) noexcept
{
    return output.tools[tool].in_contact &&
           std::ranges::any_of(output.pairs, [tool](const PairOutput& pair)
                               { return pair.tool == tool && pair.kind == AnswerKind::stale; });
}

/// True if a model has lost its server and is not static. A static model is resident as a whole and
/// needs no server.
bool HapticLoop::lacks_a_server(const FrameOutput& output) const noexcept
{
    return parts_.servers_gone != nullptr &&
           parts_.servers_gone->any_of([&output](std::size_t model)
                                       { return !output.models[model].is_static; });
}

void HapticLoop::write_devices() noexcept
{
    for (ToolPort& port : ports_)
    {
        port.write();
    }
}

void HapticLoop::note(std::size_t tool, SafetyState state, ForceOff causes) noexcept
{
    log_.note({parts_.clock->now(), frame_, static_cast<std::uint32_t>(tool), state, causes});
}

void HapticLoop::mark_stage(void* context, Stage stage) noexcept
{
    HapticLoop& loop = *static_cast<HapticLoop*>(context);
    const MonotonicTime now = loop.parts_.clock->now();
    loop.measures_.stage[static_cast<std::size_t>(stage)] = now - loop.stage_start_;
    loop.stage_start_ = now;
}

} // namespace tactus::hrtc
