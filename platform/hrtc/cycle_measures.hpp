// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/periodic_timer.hpp"
#include "platform/system_call_trap.hpp"
#include "platform/thread_usage.hpp"
#include "rt_core/records/conditioned_force.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"
#include "rt_core/records/safety.hpp"

#include <array>
#include <cstdint>

namespace tactus::hrtc
{

/// Force and torque of one tool in one cycle.
struct ToolForce
{
    Vec3 sent_n{0.0, 0.0, 0.0};   ///< That went to the device, beside the load's.
    Vec3 sent_nm{0.0, 0.0, 0.0};  ///< The torque, likewise.
    Vec3 load_n{0.0, 0.0, 0.0};   ///< That went there to carry a load: GravityCompensation.
    Vec3 load_nm{0.0, 0.0, 0.0};  ///< The torque, likewise.
    double own_n{0.0};            ///< What the program itself wanted: OwnForce.
    double sent_gripper_n{0.0};   ///< The gripper's force, likewise.
    ConditionedForce conditioned; ///< How it came about, before the safe state.
    ConditionedForce turned;      ///< The torque, likewise, in angles.
    double twist_rad{0.0};        ///< Between device and proxy, in contact.
    SafetyState state{SafetyState::reset}; ///< What the whole is doing.
    ForceOff causes{ForceOff::none};       ///< Why less than the frame's went out.
};

/// What one cycle of the loop measured besides the frame's own output.
struct CycleMeasures
{
    Cycle cycle;
    Budgets budgets;              ///< That the frame had.
    bool budgets_at_floor{false}; ///< Whether less was not to be had.
    std::array<Duration, kStages> stage;
    Duration frame;           ///< From the start of the frame to the force written.
    Duration cpu;             ///< Processor time of the thread in `frame`.
    Duration beside;          ///< What the loop did besides: bookkeeping and rehearsal.
    Duration beside_cpu;      ///< Processor time in `beside`.
    Duration lateness_of_end; ///< End of the frame after its deadline; late when > one period.
    ThreadUsage usage;        ///< Since the last cycle; no switch of the timer's sleeps is in it.
    std::uint64_t allocations{0};         ///< Since the last cycle.
    system_call_trap::TrappedCalls calls; ///< Since the loop began.
};

} // namespace tactus::hrtc
