// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/device_limits.hpp"

#include <string>
#include <string_view>

namespace tactus::hrtc
{

/// Sets device limits from `KEY=VALUE` pairs, separated by commas. The keys are the member names of
/// DeviceLimits, in SI units; those of RotationLimits begin with `rotation.`. Returns the fault,
/// and then changes nothing; empty if there is none.
[[nodiscard]] std::string set_device_limits(std::string_view text, DeviceLimits& limits);

} // namespace tactus::hrtc
