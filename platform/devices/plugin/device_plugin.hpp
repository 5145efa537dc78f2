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

// Devices in a user's shared library, for `hrtc --device plugin:FILE[,WORDS]`. Call all functions
// before the loop, on the thread that assembles the controller. Threads of the device: see
// HapticDevice.
namespace tactus
{

/// Arguments from which a library makes its device.
struct DeviceRequest
{
    std::int64_t rate_hz{1'000}; ///< Rate of the loop, which info() must allow.
    DeviceFrame frame;           ///< Frame of --device-frame, applied by the device.
    const char* words{""};       ///< Text after the file's name, for the device to read.
};

using MakeDevice = Result<std::unique_ptr<HapticDevice>, Refusal> (*)(const DeviceRequest&);
/// Function that makes a guard, called in the guardian's process before the program makes the
/// device.
using MakeGuard = Result<std::unique_ptr<DeviceGuard>, Refusal> (*)(const DeviceRequest&);

/// Layout of the types that program and library share; a library with another layout is refused.
/// The first number counts layout changes that leave all sizes equal. The rest are sizes in bytes.
using PluginLayout = std::array<std::uint32_t, 6>;
inline constexpr PluginLayout kPluginLayout{3,
                                            sizeof(DeviceInfo),
                                            sizeof(DeviceSample),
                                            sizeof(Wrench),
                                            sizeof(DeviceStatus),
                                            sizeof(DeviceRequest)};

/// Entry points of a library, exported as `tactus_device_plugin`.
struct DevicePlugin
{
    PluginLayout layout{};
    MakeDevice make{nullptr};
    MakeGuard guard{nullptr}; ///< Null: the hardware ends the force of a dead program by itself.
};

/// Loads the library for the life of the process, and makes its device. Refuses a path that does
/// not begin with '/', and a library that can't be loaded, has another layout, refuses, returns
/// null, throws, or describes a device with a fault (find_fault()). The refusal is one line that
/// names the file.
[[nodiscard]] Result<std::unique_ptr<HapticDevice>, Refusal>
load_device(const std::string& path, const DeviceRequest& request);

/// Loads the library and makes its guard; null if the library has none. Refuses like load_device().
[[nodiscard]] Result<std::unique_ptr<DeviceGuard>, Refusal>
load_guard(const std::string& path, const DeviceRequest& request);

/// True if the library has a guard; false if it has none or can't be loaded.
[[nodiscard]] bool has_guard(const std::string& path);

} // namespace tactus

extern "C"
{
    /// Defined by TACTUS_DEVICE_PLUGIN, once in a library.
    __attribute__((visibility("default"))) extern const tactus::DevicePlugin tactus_device_plugin;
}

/// Defines the entry points of a library. Arguments: a MakeDevice and, optionally, a MakeGuard.
#define TACTUS_DEVICE_PLUGIN(...)                                                                  \
    const tactus::DevicePlugin tactus_device_plugin                                                \
    {                                                                                              \
        tactus::kPluginLayout, __VA_ARGS__                                                         \
    }
