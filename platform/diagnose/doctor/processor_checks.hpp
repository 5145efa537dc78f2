// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/diagnose/doctor/machine_view.hpp"

#include <cstdint>

/// How awake the loop's processor is, and what it shares.
namespace tactus::doctor
{

/// A twentieth of the usual period: from a deeper sleep the loop comes back noticeably late.
inline constexpr std::int64_t kMostWake_us = 50;

/// Whether the processor's clock is kept up.
[[nodiscard]] Finding check_governor(const MachineView& view);
/// How long it may take to wake the processor up.
[[nodiscard]] Finding check_idle_states(const MachineView& view);
/// Whether another thread may run on the same core.
[[nodiscard]] Finding check_siblings(const MachineView& view);

} // namespace tactus::doctor
