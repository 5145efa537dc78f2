// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/placement.hpp"
#include "platform/devices/device_guard.hpp"
#include "platform/devices/haptic_device.hpp"
#include "platform/devices/simulated/device_classes.hpp"
#include "platform/devices/simulated/faulty_device.hpp"
#include "platform/devices/udp/udp_device.hpp"
#include "platform/machine/clock.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/records/device_limits.hpp"
#include "transport/base/refusal.hpp"

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
    plugin,
};

/// What --device, --device-limits and --device-frame say of one tool's device.
struct DeviceChoice
{
    DeviceKind kind{DeviceKind::simulated};
    DeviceLimits limits{kDeskClass};                         ///< Limits of simulated and dhd.
    std::string address{UdpDeviceOptions{}.address};         ///< Address of udp.
    int port{UdpDeviceOptions::kPortDefault};                ///< Port of udp.
    std::shared_ptr<const udp::Authenticator> authenticator; ///< Null without --device-key.
    int index{0};                                            ///< Number of dhd's device.
    std::string recording;                                   ///< File of replay.
    std::string library;                                     ///< File of plugin.
    std::string words;                                       ///< Words for the plugin's device.
    Similarity frame;                                        ///< Device coordinates in the world.
};

/// One of the forms that --help shows.
[[nodiscard]] Result<DeviceChoice, Refusal> parse_device(std::string_view text);

/// What the texts mean that `parse_device_fault` takes; for messages.
inline constexpr std::string_view kDeviceFaultForms =
    "KIND@FRAME+LENGTH with the kind jitter, dropout, stuck, nan, time_jump or disconnect, a frame "
    "of 0 to 1e9 and a length of 1 to 1e9 frames";

/// None when the text is none of kDeviceFaultForms.
[[nodiscard]] std::optional<DeviceFault> parse_device_fault(std::string_view text);

/// For a device that has to come or to be made.
struct DeviceWait
{
    Duration most;
    std::function<bool()> goes_on; ///< Asked meanwhile: false ends the wait. Empty: never.
    std::int64_t rate_hz{1'000};   ///< Of the loop.
};

/// Opens a device that isn't simulated, for the tool with that index; waits for one that comes by
/// udp, reads a recording as a whole. `choice` and `clock` are lent and outlive it.
[[nodiscard]] Result<std::unique_ptr<HapticDevice>, Refusal> open_device(const DeviceChoice& choice,
                                                                         std::size_t tool,
                                                                         const DeviceWait& wait,
                                                                         const Clock& clock);

/// Whether the device is this machine's, and holds a force that its program has left to it.
[[nodiscard]] bool wants_guard(const DeviceChoice& choice) noexcept;

/// In the guardian's process: what brakes such a device; none where its library has none.
[[nodiscard]] Result<std::unique_ptr<DeviceGuard>, Refusal> open_guard(const DeviceChoice& choice,
                                                                       std::int64_t rate_hz);

} // namespace tactus::hrtc
