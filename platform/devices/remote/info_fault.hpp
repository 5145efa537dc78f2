// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/haptic_device.hpp"

#include <cstddef>

namespace tactus
{

/// Of a device's name; printable ASCII, so that it may be shown as it is.
inline constexpr std::size_t kDeviceNameMax = 31;

/// Null, or one line that names what of a device's own description is out of range. It comes from
/// outside: what force is made depends on it.
[[nodiscard]] const char* find_fault(const DeviceInfo& info) noexcept;

} // namespace tactus
