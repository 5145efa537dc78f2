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

/// What one cycle of the loop measured besides the frame's own output.
struct CycleMeasures
{
    Cycle cycle;
    Budgets budgets;              ///< That the frame had.
    bool is_work_at_floor{false}; ///< Whether less was not to be had.
    std::array<Duration, kStages> stage;
    Duration frame;           ///< From the start of the frame to the force written.
    Duration cpu;             ///< Processor time of the thread in `frame`.
    Duration outside;         ///< The part of `frame` outside of Frame::run(): devices and safety.
    Duration beside;          ///< What the loop did besides: bookkeeping and rehearsal.
    Duration beside_cpu;      ///< Processor time in `beside`.
    Duration lateness_of_end; ///< End of the frame after its deadline; late when > one period.
    ThreadUsage usage;        ///< Since the last cycle; no switch of the timer's sleeps is in it.
    bool was_stopped{false};  ///< The process, from outside; since the last cycle.
    std::uint64_t allocations{0};         ///< Since the last cycle.
    system_call_trap::TrappedCalls calls; ///< Since the loop began.
};

} // namespace tactus::hrtc
