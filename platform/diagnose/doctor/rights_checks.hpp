// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/machine_view.hpp"

/// Checks of the rights that the system grants this process.
namespace tactus::doctor
{

/// Checks that a thread gets SCHED_FIFO at the priorities of loop and supervisor.
[[nodiscard]] Finding check_priority(const MachineView& view);
/// Checks that all memory of the process can be locked.
[[nodiscard]] Finding check_memory_lock(const MachineView& view);
/// Checks that the kernel doesn't merge pages into huge pages by itself.
[[nodiscard]] Finding check_huge_pages(const MachineView& view);

} // namespace tactus::doctor
