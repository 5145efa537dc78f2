// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/haptic_device.hpp"
#include "platform/machine/rt_thread.hpp"
#include "platform/machine/time.hpp"

#include <cstddef>
#include <string>

namespace tactus
{

/// Times after which a device counts as disconnected and a force as expired.
struct RemoteTimes
{
    static constexpr Duration kMin{1'000'000};
    static constexpr Duration kMax{60'000'000'000};

    /// Time without a sample after which the device is not connected. The default equals
    /// kSampleHold_s, for which a frame uses an old sample.
    Duration silence{milliseconds(20)};
    /// Time after a write at which the force ends: the watchdog against a haptic thread that hangs.
    Duration force_hold{milliseconds(20)};
};

/// Options of an I/O thread: priority 79, one below the haptic thread's default. The thread also
/// runs without real-time rights.
[[nodiscard]] RtThreadOptions io_thread_options();

/// Returns the fault in one line; empty if both times are in [RemoteTimes::kMin,
/// RemoteTimes::kMax].
[[nodiscard]] std::string find_bad_time(const RemoteTimes& times);

/// Most bytes of a device's name. The name must be printable ASCII, so that it may be shown
/// unchanged.
inline constexpr std::size_t kDeviceNameMax = 31;

/// Returns one line that names a value out of range in a device's description; null if all are in
/// range. Descriptions come from outside, and forces depend on them.
[[nodiscard]] const char* find_fault(const DeviceInfo& info) noexcept;

} // namespace tactus
