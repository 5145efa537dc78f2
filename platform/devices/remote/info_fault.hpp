// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/haptic_device.hpp"

#include <cstddef>

namespace tactus
{

/// Most bytes of a device's name. The name must be printable ASCII, so that it may be shown
/// unchanged.
inline constexpr std::size_t kDeviceNameMax = 31;

/// Returns one line that names a value out of range in a device's description; null if all are in
/// range. Descriptions come from outside, and forces depend on them.
[[nodiscard]] const char* find_fault(const DeviceInfo& info) noexcept;

} // namespace tactus
