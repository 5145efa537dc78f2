// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/machine_view.hpp"

/// Clocks, and the arithmetic that threads begin with.
namespace tactus::doctor
{

/// A timer that is coarser is one of ticks, milliseconds apart.
inline constexpr std::int64_t kMostResolution_ns = 1'000;

/// Whether the clock is read without a system call.
[[nodiscard]] Finding check_clock_source(const MachineView& view);
/// Whether timers are finer than the kernel's tick.
[[nodiscard]] Finding check_timer(const MachineView& view);
/// Whether new threads keep denormals and round to nearest.
[[nodiscard]] Finding check_float_control(const MachineView& view);

} // namespace tactus::doctor
