// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/haptic_loop.hpp"

#include "platform/allocation_counter.hpp"
#include "platform/system_call_trap.hpp"
#include "rt_core/limits.hpp"

#include <algorithm>

namespace tactus::hrtc
{

HapticLoop::HapticLoop(const LoopParts& parts, RunStatistics& statistics)
    : parts_(parts)
    , statistics_(statistics)
    , states_(parts.devices.size())
    , samples_(parts.devices.size())
    , conditioned_(parts.devices.size())
    , jumps_(parts.limits, parts.poses)
    , forces_n_(parts.devices.size(), Vec3(0.0, 0.0, 0.0))
    , end_(parts.frames)
{
    TACTUS_ASSERT(parts.limits.size() == parts.devices.size());
    TACTUS_ASSERT(parts.conditioners.size() == parts.devices.size());
    for (const SafetyLimits& limits : parts.limits)
    {
        safe_states_.emplace_back(limits);
    }
    for (const ConditionerSetup& setup : parts.conditioners)
    {
        conditioners_.emplace_back(setup);
    }
    measures_.budgets = parts.governor != nullptr ? parts.governor->budgets() : parts.budgets;
}

void HapticLoop::run() noexcept
{
    allocation_counter::mark_this_thread(true);
    haptic_thread_.store(std::this_thread::get_id());
    fade_frames_ = static_cast<std::uint64_t>(kFadeTime_s / to_seconds(parts_.timer->period())) + 1;
    ThreadUsage usage = read_thread_usage();
    std::uint64_t allocations = allocation_counter::of_this_thread().allocations;
    MonotonicTime end = parts_.clock->now();
    for (; !has_to_end(); ++frame_)
    {
        wait_for_deadline(end, usage.cpu_time);
        const Duration cpu_before = read_thread_cpu_time();
        const MonotonicTime start = parts_.clock->now();
        heartbeat_.beat(start);
        stage_start_ = start;
        read_devices(measures_.cycle.periods);
        read_poses(start);
        const FrameOutput output = run_frame();
        jumps_.remember(output);
        make_safe(output);
        write_devices();
        end = parts_.clock->now();
        const ThreadUsage now = read_thread_usage();
        record(output);
        measures_.frame = end - start;
        measures_.cpu = now.cpu_time - cpu_before;
        measures_.lateness_of_end = end - measures_.cycle.deadline;
        measures_.usage = now - usage;
        usage = now;
        measures_.allocations = allocation_counter::of_this_thread().allocations - allocations;
        allocations += measures_.allocations;
        measures_.calls = system_call_trap::of_this_thread();
        statistics_.add(output, forces_n_, conditioned_, measures_);
        show(output, start);
        choose_budgets(output);
        frames_done_.store(frame_ + 1, std::memory_order_relaxed);
    }
    heartbeat_.rest();
    for (const std::unique_ptr<HapticDevice>& device : parts_.devices)
    {
        device->write({0.0, 0.0, 0.0});
    }
    allocation_counter::mark_this_thread(false);
    done_.store(true);
}

/// When somebody wants it, as soon as the forces have had the time to fade.
bool HapticLoop::has_to_end() noexcept
{
    if (stopped_.load(std::memory_order_relaxed))
    {
        end_ = std::min(end_, frame_ + fade_frames_); // The first time it counts.
    }
    return frame_ >= end_ || failing_.load();
}

/// `since`: when the last frame ended; `cpu_since`: the thread's processor time then.
void HapticLoop::wait_for_deadline(MonotonicTime since, Duration cpu_since) noexcept
{
    measures_.beside = parts_.clock->now() - since;
    measures_.beside_cpu = read_thread_cpu_time() - cpu_since;
    parts_.timer->sleep_until_margin();
    const Duration cpu_awake = read_thread_cpu_time();
    const MonotonicTime awake = parts_.clock->now();
    rehearse();
    measures_.beside += parts_.clock->now() - awake;
    measures_.beside_cpu += read_thread_cpu_time() - cpu_awake;
    measures_.cycle = parts_.timer->spin_until_deadline();
}

/// Rehearsal and frame are what must make no system call.
void HapticLoop::rehearse() noexcept
{
    system_call_trap::mark_frame(true);
    parts_.frame->rehearse();
    system_call_trap::mark_frame(false);
}

FrameOutput HapticLoop::run_frame() noexcept
{
    system_call_trap::mark_frame(true);
    const FrameOutput output =
        parts_.frame->run(states_, parts_.poses, measures_.budgets, {&mark_stage, this});
    system_call_trap::mark_frame(false);
    return output;
}

/// After the forces have gone out and the frame's time was taken.
void HapticLoop::record(const FrameOutput& output) noexcept
{
    if (parts_.tap != nullptr)
    {
        parts_.tap->record(states_, parts_.poses, measures_.budgets, output);
    }
}

/// Between frames, so that the frame that follows takes its budgets as an input like any other.
void HapticLoop::choose_budgets(const FrameOutput& output) noexcept
{
    if (parts_.governor != nullptr)
    {
        const auto stage = [this](Stage s) { return measures_.stage[static_cast<std::size_t>(s)]; };
        parts_.governor->observe({measures_.frame,
                                  stage(Stage::refine) + stage(Stage::refit) + stage(Stage::query),
                                  output.work});
        measures_.budgets = parts_.governor->budgets();
        measures_.budgets_at_floor = parts_.governor->is_at_floor();
    }
}

void HapticLoop::fail() noexcept
{
    // A bug that is found while the forces fade ends that, too.
    const bool is_first = !failing_.exchange(true);
    if (is_first && haptic_thread_.load() == std::this_thread::get_id())
    {
        fade_last_forces();
    }
    for (const std::unique_ptr<HapticDevice>& device : parts_.devices)
    {
        device->brake();
    }
    failed_.store(true);
}

/// On the haptic thread, in the middle of a frame that can't be trusted any more: it uses nothing
/// but what was sent last.
void HapticLoop::fade_last_forces() noexcept
{
    for (std::size_t i = 0; i < forces_n_.size(); ++i)
    {
        note(i, SafetyState::brake, ForceOff::assertion);
    }
    for (std::uint64_t left = fade_frames_; left > 0; --left)
    {
        const double gain = static_cast<double>(left - 1) / static_cast<double>(fade_frames_);
        for (std::size_t i = 0; i < forces_n_.size(); ++i)
        {
            const Vec3 force_n = gain * forces_n_[i];
            parts_.devices[i]->write({force_n.x(), force_n.y(), force_n.z()});
        }
        heartbeat_.beat(parts_.clock->now());
        parts_.timer->sleep_until_margin();
        static_cast<void>(parts_.timer->spin_until_deadline());
    }
    heartbeat_.rest();
}

void HapticLoop::read_devices(std::uint32_t periods) noexcept
{
    for (std::size_t i = 0; i < states_.size(); ++i)
    {
        const DeviceSample sample = parts_.devices[i]->read();
        states_[i].position_m = Vec3(sample.position_world_m[0], sample.position_world_m[1],
                                     sample.position_world_m[2]);
        states_[i].sample_time_ns = sample.time.ns;
        states_[i].elapsed_periods = periods;
        states_[i].valid = sample.valid && sample.connected;
        samples_[i] = sample;
    }
}

/// What the network says of the objects enters the frame here and nowhere else.
void HapticLoop::read_poses(MonotonicTime now) noexcept
{
    if (parts_.pose_door != nullptr)
    {
        parts_.pose_door->refresh(now);
        parts_.poses = parts_.pose_door->poses();
        jumps_.see(parts_.poses);
    }
}

void HapticLoop::show(const FrameOutput& output, MonotonicTime start) noexcept
{
    if (parts_.telemetry != nullptr)
    {
        parts_.telemetry->show({start, states_, forces_n_, parts_.poses, output}, statistics_);
    }
}

void HapticLoop::make_safe(const FrameOutput& output) noexcept
{
    for (std::size_t i = 0; i < forces_n_.size(); ++i)
    {
        conditioned_[i] = conditioners_[i].condition(wish_of(i, output.tools[i]));
        const Vec3& force_n = conditioned_[i].force_n;
        const SafetyOutput safe = safe_states_[i].step(safety_input(i, output, force_n));
        if (safe.force_n != force_n)
        {
            conditioners_[i].follow(safe.force_n);
        }
        forces_n_[i] = safe.force_n;
        if (safe.has_changed)
        {
            note(i, safe.state, safe.causes);
        }
    }
}

ForceWish HapticLoop::wish_of(std::size_t tool, const ToolOutput& output) const noexcept
{
    const ToolState& state = states_[tool];
    const double norm_n = output.force_n.norm();
    ForceWish wish{output.force_n, state.position_m, output.stiffness_n_per_m, 0.0,
                   state.elapsed_periods};
    if (norm_n > 0.0)
    {
        wish.stretch_m = (output.proxy_m - state.position_m).dot(output.force_n) / norm_n;
    }
    return wish;
}

SafetyInput HapticLoop::safety_input(std::size_t tool, const FrameOutput& output,
                                     const Vec3& force_n) noexcept
{
    const std::uint32_t periods = std::max(states_[tool].elapsed_periods, 1U);
    SafetyInput input;
    input.position_m = states_[tool].position_m;
    if (const auto& velocity = samples_[tool].velocity_world_m_per_s)
    {
        input.velocity_m_per_s = Vec3((*velocity)[0], (*velocity)[1], (*velocity)[2]);
        input.has_velocity = true;
    }
    input.sample_time_ns = states_[tool].sample_time_ns;
    input.elapsed_s = to_seconds(parts_.timer->period()) * static_cast<double>(periods);
    input.elapsed_periods = periods;
    input.force_n = force_n;
    input.proxy_m = output.tools[tool].proxy_m;
    input.sample_fault = parts_.frame->sample_fault(static_cast<std::uint32_t>(tool));
    input.causes = known_causes(tool, output);
    input.force_was_lost = take_back(tool);
    return input;
}

ForceOff HapticLoop::known_causes(std::size_t tool, const FrameOutput& output) const noexcept
{
    const auto when = [](bool is_so, ForceOff cause) { return is_so ? cause : ForceOff::none; };
    const bool is_stale =
        output.tools[tool].in_contact &&
        std::ranges::any_of(output.pairs, [tool](const PairOutput& pair)
                            { return pair.tool == tool && pair.kind == AnswerKind::stale; });
    return when(frame_ + fade_frames_ >= end_, ForceOff::software) |
           when(!samples_[tool].connected, ForceOff::disconnect) |
           when(!samples_[tool].deadman_held, ForceOff::deadman) | when(is_stale, ForceOff::stale) |
           when(jumps_.has_jumped(tool), ForceOff::jump) |
           when(lacks_a_host(output), ForceOff::host);
}

/// A model that is here as a whole needs nobody to send more of it.
bool HapticLoop::lacks_a_host(const FrameOutput& output) const noexcept
{
    if (parts_.hosts_gone == nullptr)
    {
        return false;
    }
    std::uint32_t gone = parts_.hosts_gone->load(std::memory_order_relaxed); // Orders nothing.
    for (std::size_t i = 0; i < output.models.size(); ++i)
    {
        gone &= output.models[i].is_static ? ~(1U << i) : ~0U;
    }
    return gone != 0;
}

/// Whether the device has dropped the force by itself or at somebody's wish; a brake is released.
bool HapticLoop::take_back(std::size_t tool) noexcept
{
    switch (parts_.devices[tool]->status().state)
    {
    case DeviceState::brake:
        if (!failing_.load())
        {
            parts_.devices[tool]->release_brake();
        }
        return true;
    case DeviceState::idle:
        return safe_states_[tool].gain() > 0.0;
    case DeviceState::force:
        break;
    }
    return false;
}

void HapticLoop::write_devices() noexcept
{
    for (std::size_t i = 0; i < forces_n_.size(); ++i)
    {
        const Vec3& force_n = forces_n_[i];
        parts_.devices[i]->write({force_n.x(), force_n.y(), force_n.z()});
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
