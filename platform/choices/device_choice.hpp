// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/haptic_device.hpp"
#include "platform/devices/simulated/device_classes.hpp"
#include "platform/devices/simulated/faulty_device.hpp"
#include "platform/devices/udp/udp_device_options.hpp"
#include "platform/machine/time.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/math/similarity.hpp"
#include "rt_core/records/device_limits.hpp"
#include "transport/base/refusal.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace tactus
{
class Clock;
class DeviceGuard;
struct ReplayDeviceOptions;
} // namespace tactus

namespace tactus::hrtc
{

enum class DeviceKind : std::uint8_t
{
    simulated,
    udp,
    dhd,
    replay,
    plugin,
    program, ///< Made by the program that runs the loop.
};

/// Device of one tool, as given by --device, --device-limits and --device-frame.
struct DeviceChoice
{
    DeviceKind kind{DeviceKind::simulated};
    DeviceLimits limits{kDeskClass};                 ///< Limits of a sim or DHD device.
    std::string address{UdpDeviceOptions{}.address}; ///< Address of a UDP device.
    int port{UdpDeviceOptions::kPortDefault};        ///< Port of a UDP device.
    /// Authenticator of a UDP device; null without --device-key.
    std::shared_ptr<const udp::Authenticator> authenticator;
    int index{0};          ///< Index of a DHD device.
    std::string recording; ///< File of a replayed device.
    std::string library;   ///< Library of a plugin.
    std::string words;     ///< Words for the plugin's device.
    /// Pose of the device's coordinates in the world.
    Similarity frame;
    /// Makes the device of DeviceKind::program; empty for others.
    std::function<Result<std::unique_ptr<HapticDevice>, Refusal>()> make;
};

/// Parses one of the forms that --help shows.
[[nodiscard]] Result<DeviceChoice, Refusal> parse_device(std::string_view text);

/// Forms of text that parse_device_fault() takes, for messages.
inline constexpr std::string_view kDeviceFaultForms =
    "KIND@FRAME+LENGTH with the kind jitter, dropout, stuck, nan, time_jump or disconnect, a frame "
    "of 0 to 1e9 and a length of 1 to 1e9 frames";

/// Device fault that the text gives; none if it has none of kDeviceFaultForms.
[[nodiscard]] std::optional<DeviceFault> parse_device_fault(std::string_view text);

/// Limits of the wait for a device to connect or to be created.
struct DeviceWait
{
    Duration most;
    /// Called during the wait; false ends it. Empty: only `most` does.
    std::function<bool()> goes_on;
    std::int64_t rate_hz{1'000}; ///< Rate of the loop.
};

/// Opens a device that isn't simulated, for the tool with that index. Waits for a UDP device to
/// connect; reads the whole recording of a replayed one. `choice` and `clock` must outlive the
/// device.
[[nodiscard]] Result<std::unique_ptr<HapticDevice>, Refusal> open_device(const DeviceChoice& choice,
                                                                         std::size_t tool,
                                                                         const DeviceWait& wait,
                                                                         const Clock& clock);

/// True if the device is attached to this machine and may hold a force after its program's end.
[[nodiscard]] bool wants_guard(const DeviceChoice& choice) noexcept;

/// Guard that brakes a device of wants_guard(), for the guardian's process. Null if a plugin's
/// library has no guard.
[[nodiscard]] Result<std::unique_ptr<DeviceGuard>, Refusal> open_guard(const DeviceChoice& choice,
                                                                       std::int64_t rate_hz);

/// Reads the samples of a device from a recording of `hrtc --record`, one a frame. The device is
/// that of tool `tool`, or of the first tool if there is no such tool. Largest force, largest
/// torque and rate are those of the recorded run. With a clutch, the pose is the device pose, not
/// the tool's. Logs missing parts of the recording. Takes as much memory as the recording, and 250
/// bytes a frame.
[[nodiscard]] Result<ReplayDeviceOptions, Refusal> read_recorded_motion(const std::string& path,
                                                                        std::size_t tool);

/// Parses X,Y,Z[,RX,RY,RZ[,SCALE]]: the pose in the world of an object's or device's source frame.
/// X,Y,Z is the translation in metres, RX,RY,RZ the rotation vector (axis times angle) in degrees,
/// and SCALE the scale.
[[nodiscard]] Result<Similarity, Refusal> parse_placement(std::string_view text);

} // namespace tactus::hrtc
