// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/haptic_loop.hpp"

#include "platform/allocation_counter.hpp"
#include "platform/system_call_trap.hpp"

namespace tactus::hrtc
{

HapticLoop::HapticLoop(const LoopParts& parts, RunStatistics& statistics)
    : parts_(parts), statistics_(statistics), states_(parts.devices.size())
{
    measures_.budgets = parts.governor != nullptr ? parts.governor->budgets() : parts.budgets;
}

void HapticLoop::run() noexcept
{
    allocation_counter::mark_this_thread(true);
    ThreadUsage usage = read_thread_usage();
    std::uint64_t allocations = allocation_counter::of_this_thread().allocations;
    for (std::uint64_t i = 0; i < parts_.frames && !stopped_.load(std::memory_order_relaxed); ++i)
    {
        parts_.timer->sleep_until_margin();
        rehearse();
        measures_.cycle = parts_.timer->spin_until_deadline();
        const MonotonicTime start = parts_.clock->now();
        stage_start_ = start;
        read_devices(measures_.cycle.periods);
        const FrameOutput output = run_frame();
        write_devices(output.tools);
        const MonotonicTime end = parts_.clock->now();
        record(output);
        measures_.frame = end - start;
        measures_.lateness_of_end = end - measures_.cycle.deadline;
        const ThreadUsage now = read_thread_usage();
        measures_.usage = now - usage;
        usage = now;
        measures_.allocations = allocation_counter::of_this_thread().allocations - allocations;
        allocations += measures_.allocations;
        measures_.calls = system_call_trap::of_this_thread();
        statistics_.add(output, measures_);
        choose_budgets(output);
        frames_done_.store(i + 1, std::memory_order_relaxed);
    }
    for (const std::unique_ptr<HapticDevice>& device : parts_.devices)
    {
        device->write({0.0, 0.0, 0.0});
    }
    allocation_counter::mark_this_thread(false);
    done_.store(true);
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
    for (const std::unique_ptr<HapticDevice>& device : parts_.devices)
    {
        device->brake();
    }
    failed_.store(true);
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
        states_[i].valid = sample.valid;
    }
}

void HapticLoop::write_devices(std::span<const ToolOutput> outputs) noexcept
{
    for (std::size_t i = 0; i < outputs.size(); ++i)
    {
        const Vec3& force = outputs[i].force_n;
        parts_.devices[i]->write({force.x(), force.y(), force.z()});
    }
}

void HapticLoop::mark_stage(void* context, Stage stage) noexcept
{
    HapticLoop& loop = *static_cast<HapticLoop*>(context);
    const MonotonicTime now = loop.parts_.clock->now();
    loop.measures_.stage[static_cast<std::size_t>(stage)] = now - loop.stage_start_;
    loop.stage_start_ = now;
}

} // namespace tactus::hrtc
