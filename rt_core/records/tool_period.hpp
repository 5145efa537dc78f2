// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "rt_core/records/safety.hpp"
#include "rt_core/records/work_counters.hpp"

#include <cstdint>

// Any thread: values.
namespace tactus
{

/// What a loop knows of a period that neither frame nor device tells.
struct PeriodContext
{
    double elapsed_s{0.0}; ///< True time since the last frame, >= 0.
    ForceOff causes{ForceOff::none};
    /// The largest surface damping of what the tool touches, in N s/m: it lowers the stiffness cap.
    /// Finite, >= 0.
    double surface_damping_n_s_per_m{0.0};
    double force_left{1.0}; ///< Of the last force at the device, 0 to 1: less than all after a
                            ///< brake or the device's own watchdog.
};

/// What a period knows of one tool beside its force: what the stages of a ForcePipeline go by.
/// World frame, SI.
struct ToolPeriod
{
    Vec3 hand_m{0.0, 0.0, 0.0}; ///< Of the device's sample; used only while it has no fault.
    Mat3 hand_rotation{Mat3::Identity()};
    Vec3 turned_rad{0.0, 0.0, 0.0}; ///< By the hand about the world's axes, summed up.
    Vec3 velocity_m_per_s{0.0, 0.0, 0.0};
    bool has_velocity{false}; ///< False: from the positions.
    Vec3 turning_rad_per_s{0.0, 0.0, 0.0};
    bool has_turning{false};               ///< False: from turned_rad.
    std::int64_t sample_time_ns{0};        ///< 0: the device has none, every sample is new.
    double elapsed_s{0.0};                 ///< Since the last frame, the true one after a stall.
    std::uint32_t elapsed_periods{1};      ///< The same in whole periods.
    double stretch_m{0.0};                 ///< Between the frame's proxy and the hand's tool.
    double twist_rad{0.0};                 ///< The angle between them, 0 .. pi.
    bool is_touching{false};               ///< ToolOutput::in_contact.
    double object_way_m{0.0};              ///< ToolOutput's, believed.
    double object_turn_rad{0.0};           ///< ToolOutput's.
    Vec3 carried_m{0.0, 0.0, 0.0};         ///< ToolOutput's: the proxy's way with objects.
    Vec3 carried_rad{0.0, 0.0, 0.0};       ///< ToolOutput's.
    double surface_damping_n_s_per_m{0.0}; ///< PeriodContext's.
    FrameFault faults{FrameFault::none};   ///< The frame's of this tool: faults_of().
    ForceOff causes{ForceOff::none};       ///< What the caller knows of by itself.
    double force_left{1.0};                ///< PeriodContext's.
};

} // namespace tactus
