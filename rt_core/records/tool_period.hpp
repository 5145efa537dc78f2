// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "rt_core/records/safety.hpp"
#include "rt_core/records/work_counters.hpp"

#include <cstdint>

// Usable on any thread: plain values.
namespace tactus
{

/// Data of a period that neither frame nor device reports.
struct PeriodContext
{
    double elapsed_s{0.0}; ///< True time since the last frame, >= 0.
    ForceOff causes{ForceOff::none};
    /// Largest surface damping of the touched objects, in N s/m: it lowers the stiffness limit.
    /// Finite, >= 0.
    double surface_damping_n_s_per_m{0.0};
    /// Share of the last force that the device still outputs, 0 .. 1: below 1 after a brake, or
    /// after the device's watchdog acted.
    double force_left{1.0};
};

/// Data of one tool in a period besides its force, used by the stages of a ForcePipeline. World
/// frame, SI.
struct ToolPeriod
{
    Vec3 device_m{0.0, 0.0, 0.0}; ///< Position of the device's sample; used only without a fault.
    Mat3 device_rotation{Mat3::Identity()};
    /// Sum of the device's rotations since the start, as rotation vectors about the world's axes.
    Vec3 turned_rad{0.0, 0.0, 0.0};
    Vec3 velocity_m_per_s{0.0, 0.0, 0.0};
    bool has_velocity{false}; ///< False: the velocity follows from the positions.
    Vec3 rotation_rad_per_s{0.0, 0.0, 0.0};
    bool has_rotation{false}; ///< False: the angular velocity follows from turned_rad.
    /// Time of the sample; 0: the device reports no time, and every sample counts as new.
    std::int64_t sample_time_ns{0};
    double elapsed_s{0.0};            ///< True time since the last frame, also after a stall.
    std::uint32_t elapsed_periods{1}; ///< Whole periods since the last frame.
    double stretch_m{0.0};            ///< Distance between the frame's proxy and the tool's goal.
    double twist_rad{0.0};    ///< Angle between the frame's proxy and the tool's goal, 0 .. pi.
    bool is_touching{false};  ///< ToolOutput::in_contact.
    double object_way_m{0.0}; ///< ToolOutput::object_way_m.
    double object_rotation_rad{0.0};       ///< Same field of ToolOutput.
    Vec3 carried_m{0.0, 0.0, 0.0};         ///< Same field of ToolOutput.
    Vec3 carried_rad{0.0, 0.0, 0.0};       ///< Same field of ToolOutput.
    double surface_damping_n_s_per_m{0.0}; ///< Same field of PeriodContext.
    FrameFault faults{FrameFault::none};   ///< Faults of this tool in the frame: faults_of().
    ForceOff causes{ForceOff::none};       ///< Causes for a fade that the stages' caller has found.
    double force_left{1.0};                ///< Same field of PeriodContext.
};

} // namespace tactus
