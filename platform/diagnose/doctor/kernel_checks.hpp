// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/machine_view.hpp"

/// Checks of the kernel's activities that may delay the loop.
namespace tactus::doctor
{

/// Checks that the kernel has PREEMPT_RT.
[[nodiscard]] Finding check_preemption(const MachineView& view);
/// Checks the share of a processor that real-time threads may use.
[[nodiscard]] Finding check_throttling(const MachineView& view);
/// Checks that the kernel doesn't move locked memory.
[[nodiscard]] Finding check_compaction(const MachineView& view);
/// Checks that the loop's processor is isolated from other threads.
[[nodiscard]] Finding check_isolation(const MachineView& view);
/// Checks that no device interrupts the loop's processor.
[[nodiscard]] Finding check_interrupts(const MachineView& view);

} // namespace tactus::doctor
