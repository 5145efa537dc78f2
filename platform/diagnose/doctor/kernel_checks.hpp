// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/machine_view.hpp"

/// What the kernel may do while the loop wants to run.
namespace tactus::doctor
{

/// Whether the kernel has PREEMPT_RT.
[[nodiscard]] Finding check_preemption(const MachineView& view);
/// What share of a processor real-time threads may have.
[[nodiscard]] Finding check_throttling(const MachineView& view);
/// Whether locked memory stays where it is.
[[nodiscard]] Finding check_compaction(const MachineView& view);
/// Whether the loop's processor is kept free of other threads.
[[nodiscard]] Finding check_isolation(const MachineView& view);
/// Whether devices may interrupt the loop's processor.
[[nodiscard]] Finding check_interrupts(const MachineView& view);

} // namespace tactus::doctor
