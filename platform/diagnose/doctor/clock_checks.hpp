// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/machine_view.hpp"

/// Checks of the clocks, and of the floating-point control of new threads.
namespace tactus::doctor
{

/// Coarsest resolution of a fine timer. Coarser timers follow ticks, milliseconds apart.
inline constexpr std::int64_t kMostResolution_ns = 1'000;

/// Checks that the clock is read without a system call.
[[nodiscard]] Finding check_clock_source(const MachineView& view);
/// Checks that timers are finer than the kernel's tick.
[[nodiscard]] Finding check_timer(const MachineView& view);
/// Checks that new threads keep denormals and round to nearest.
[[nodiscard]] Finding check_float_control(const MachineView& view);

} // namespace tactus::doctor
