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

// A device of one's own in a shared library, for `hrtc --device plugin:FILE[,WORDS]`. Before the
// loop, on the thread that assembles the controller; the device itself is used as HapticDevice
// says.
namespace tactus
{

/// What the device is to be.
struct DeviceWish
{
    std::int64_t rate_hz{1'000}; ///< Of the loop; info() has to allow it.
    DeviceFrame frame;           ///< --device-frame: the device applies it.
    const char* words{""};       ///< What stands behind the file's name, for the device to read.
};

using MakeDevice = Result<std::unique_ptr<HapticDevice>, Refusal> (*)(const DeviceWish&);
/// In the guardian's process, before the device is made in the program's.
using MakeGuard = Result<std::unique_ptr<DeviceGuard>, Refusal> (*)(const DeviceWish&);

/// Of what passes between program and library; a library of other sizes is refused. The first
/// number counts what sizes don't show.
using PluginLayout = std::array<std::uint32_t, 6>;
inline constexpr PluginLayout kPluginLayout{3,
                                            sizeof(DeviceInfo),
                                            sizeof(DeviceSample),
                                            sizeof(Wrench),
                                            sizeof(DeviceStatus),
                                            sizeof(DeviceWish)};

/// What a library tells of itself, under the name tactus_device_plugin.
struct DevicePlugin
{
    PluginLayout layout{};
    MakeDevice make{nullptr};
    MakeGuard guard{nullptr}; ///< Null: the hardware ends the force of a dead program by itself.
};

/// Loads the library, which stays for the life of the process, and makes its device. One without a
/// folder in its name is looked for where the program was started. Refused in a line that names the
/// file: what can't be loaded, has another layout, refuses itself, makes nothing or throws, or says
/// of itself what no device may (find_fault()).
[[nodiscard]] Result<std::unique_ptr<HapticDevice>, Refusal> load_device(const std::string& path,
                                                                         const DeviceWish& wish);

/// Loads the library and makes its guard; none where it has none. Refused as load_plugin() does.
[[nodiscard]] Result<std::unique_ptr<DeviceGuard>, Refusal> load_guard(const std::string& path,
                                                                       const DeviceWish& wish);

/// Whether a library that load_device() takes has one.
[[nodiscard]] bool has_guard(const std::string& path);

} // namespace tactus

extern "C"
{
    /// Defined by TACTUS_DEVICE_PLUGIN, once in a library.
    __attribute__((visibility("default"))) extern const tactus::DevicePlugin tactus_device_plugin;
}

/// Makes a library of the source that says it: of a MakeDevice, and a MakeGuard if there is one.
#define TACTUS_DEVICE_PLUGIN(...)                                                                  \
    const tactus::DevicePlugin tactus_device_plugin                                                \
    {                                                                                              \
        tactus::kPluginLayout, __VA_ARGS__                                                         \
    }
