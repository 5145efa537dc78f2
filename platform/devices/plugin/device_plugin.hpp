// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/device_frame.hpp"
#include "platform/devices/device_guard.hpp"
#include "platform/devices/haptic_device.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <string>

// A user's device in a shared library, for `hrtc --device plugin:FILE[,WORDS]`. Before the loop, on
// the thread that assembles the controller; the device itself is used as HapticDevice says.
namespace tactus
{

/// Options of the device.
struct DeviceRequest
{
    std::int64_t rate_hz{1'000}; ///< Rate of the loop, which info() must allow.
    DeviceFrame frame;           ///< Frame of --device-frame, applied by the device.
    const char* words{""};       ///< Text after the file's name, for the device to read.
};

using MakeDevice = Result<std::unique_ptr<HapticDevice>, Refusal> (*)(const DeviceRequest&);
/// Makes a guard in the guardian's process, before the device is made in the program's.
using MakeGuard = Result<std::unique_ptr<DeviceGuard>, Refusal> (*)(const DeviceRequest&);

/// Layout of the types exchanged between program and library; a library with another is refused.
/// The first number counts changes that sizes don't show.
using PluginLayout = std::array<std::uint32_t, 6>;
inline constexpr PluginLayout kPluginLayout{3,
                                            sizeof(DeviceInfo),
                                            sizeof(DeviceSample),
                                            sizeof(Wrench),
                                            sizeof(DeviceStatus),
                                            sizeof(DeviceRequest)};

/// Entry points of a library, under the name tactus_device_plugin.
struct DevicePlugin
{
    PluginLayout layout{};
    MakeDevice make{nullptr};
    MakeGuard guard{nullptr}; ///< Null: the hardware ends the force of a dead program by itself.
};

/// Loads the library, which stays for the life of the process, and makes its device. A path without
/// a folder is relative to the working directory. Refused in a line that names the file: a library
/// that can't be loaded, has another layout, refuses, makes nothing, throws, or describes a faulty
/// device (find_fault()).
[[nodiscard]] Result<std::unique_ptr<HapticDevice>, Refusal>
load_device(const std::string& path, const DeviceRequest& request);

/// Loads the library and makes its guard; none if it has none. Refused as load_plugin() does.
[[nodiscard]] Result<std::unique_ptr<DeviceGuard>, Refusal>
load_guard(const std::string& path, const DeviceRequest& request);

/// True if the library, accepted by load_device(), has a guard.
[[nodiscard]] bool has_guard(const std::string& path);

} // namespace tactus

extern "C"
{
    /// Defined by TACTUS_DEVICE_PLUGIN, once in a library.
    __attribute__((visibility("default"))) extern const tactus::DevicePlugin tactus_device_plugin;
}

/// Makes a plugin of the library. Arguments: a MakeDevice, and a MakeGuard if there is one.
#define TACTUS_DEVICE_PLUGIN(...)                                                                  \
    const tactus::DevicePlugin tactus_device_plugin                                                \
    {                                                                                              \
        tactus::kPluginLayout, __VA_ARGS__                                                         \
    }
