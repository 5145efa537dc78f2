// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/machine_view.hpp"

#include <cstdint>

/// Checks of the power states of the loop's processor, and of shared cores.
namespace tactus::doctor
{

/// Longest wake-up time without notable delay, a twentieth of the usual period.
inline constexpr std::int64_t kMostWake_us = 50;

/// Checks that the processor's clock is kept high.
[[nodiscard]] Finding check_governor(const MachineView& view);
/// Checks the longest wake-up time of the processor.
[[nodiscard]] Finding check_idle_states(const MachineView& view);
/// Checks that no other thread can run on the same core.
[[nodiscard]] Finding check_siblings(const MachineView& view);

} // namespace tactus::doctor
