// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/base/refusal.hpp"
#include "platform/clock.hpp"
#include "platform/haptic_device.hpp"
#include "platform/hrtc/placement.hpp"
#include "platform/simulated/device_classes.hpp"
#include "platform/simulated/faulty_device.hpp"
#include "platform/udp/udp_device.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/records/device_limits.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace tactus::hrtc
{

enum class DeviceKind : std::uint8_t
{
    simulated,
    udp,
    dhd,
    replay,
};

/// What --device and --device-frame say of one tool's device.
struct DeviceChoice
{
    DeviceKind kind{DeviceKind::simulated};
    DeviceLimits limits{kDeskClass};                 ///< Of the simulated.
    std::string address{UdpDeviceOptions{}.address}; ///< Of udp.
    int port{UdpDeviceOptions::kPortDefault};        ///< Of udp.
    int index{0};                                    ///< Of dhd.
    std::string recording;                           ///< Of replay: the file.
    Similarity frame;                                ///< Device coordinates in the world.
};

/// What the texts mean that `parse_device` takes; for messages.
inline constexpr std::string_view kDeviceForms =
    "sim, sim:CLASS with touch, omega or delta, udp, udp:PORT, udp:ADDRESS:PORT with a numeric "
    "IPv4 address and a port of 1024 to 65535, "
    "dhd, dhd:INDEX with 0 to 63, or replay:FILE with what hrtc --record wrote";

/// None when the text is none of kDeviceForms.
[[nodiscard]] std::optional<DeviceChoice> parse_device(std::string_view text);

/// What the texts mean that `parse_device_fault` takes; for messages.
inline constexpr std::string_view kDeviceFaultForms =
    "KIND@FRAME+LENGTH with the kind jitter, dropout, stuck, nan, time_jump or disconnect, a frame "
    "of 0 to 1e9 and a length of 1 to 1e9 frames";

/// None when the text is none of kDeviceFaultForms.
[[nodiscard]] std::optional<DeviceFault> parse_device_fault(std::string_view text);

/// For a device that has to come.
struct DeviceWait
{
    Duration most;
    std::function<bool()> goes_on; ///< Asked meanwhile: false ends the wait. Empty: never.
};

/// Opens a device that isn't simulated, for the tool with that index; waits for one that comes by
/// udp, reads a recording as a whole. `clock` is lent and outlives it.
[[nodiscard]] Result<std::unique_ptr<HapticDevice>, Refusal> open_device(const DeviceChoice& choice,
                                                                         std::size_t tool,
                                                                         const DeviceWait& wait,
                                                                         const Clock& clock);

} // namespace tactus::hrtc
