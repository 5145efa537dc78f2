// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/device_limits.hpp"

#include <string>
#include <string_view>

namespace tactus::hrtc
{

/// Sets what the text says of a device, `KEY=VALUE` with commas between: the keys are the names of
/// DeviceLimits' numbers, those of its turning with `turn.` before them, in SI. Returns what is
/// wrong with it, and then changes nothing; empty when all is well.
[[nodiscard]] std::string set_device_limits(std::string_view text, DeviceLimits& limits);

} // namespace tactus::hrtc
