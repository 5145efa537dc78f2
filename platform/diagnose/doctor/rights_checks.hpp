// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/machine_view.hpp"

/// What the system lets this process do.
namespace tactus::doctor
{

/// Whether a thread gets SCHED_FIFO at the priorities of loop and supervisor.
[[nodiscard]] Finding check_priority(const MachineView& view);
/// Whether all memory of the process may be locked.
[[nodiscard]] Finding check_memory_lock(const MachineView& view);
/// Whether the kernel puts huge pages together behind everybody's back.
[[nodiscard]] Finding check_huge_pages(const MachineView& view);

} // namespace tactus::doctor
