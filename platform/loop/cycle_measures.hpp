// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/periodic_timer.hpp"
#include "platform/machine/system_call_trap.hpp"
#include "platform/machine/thread_usage.hpp"
#include "rt_core/records/frame_input.hpp"

#include <array>
#include <cstdint>

namespace tactus::hrtc
{

/// Measures of one cycle of the loop besides the frame's own output.
struct CycleMeasures
{
    Cycle cycle;
    Budgets budgets;
    bool is_work_at_floor{false}; ///< True if the work budget can't be lower.
    std::array<Duration, kStages> stage;
    Duration frame;      ///< Time from the start of the frame to the force written.
    Duration cpu;        ///< Processor time of the thread in `frame`.
    Duration outside;    ///< Part of `frame` outside Frame::run(): devices and safety.
    Duration beside;     ///< Time for bookkeeping and cache warming between frames.
    Duration beside_cpu; ///< Processor time in `beside`.
    /// Time from the frame's deadline to its end; missed above one period.
    Duration lateness_of_end;
    ThreadUsage usage; ///< Usage since the last cycle, without switches of the timer's sleeps.
    bool was_stopped{false}; ///< True if the process was stopped from outside since the last cycle.
    std::uint64_t allocations{0};         ///< Allocations since the last cycle.
    system_call_trap::TrappedCalls calls; ///< Trapped system calls since the loop began.
};

} // namespace tactus::hrtc
