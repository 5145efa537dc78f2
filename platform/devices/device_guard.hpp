// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus
{

/// The guard of a device, in a process of its own: ends the force if the program that drives the
/// device dies. It is made before the device is opened, and holds all resources of brake(), since
/// there may be no memory or file by then. Used by the one thread of that process.
class DeviceGuard
{
public:
    virtual ~DeviceGuard() = default;

    /// The program has died, or is about to: ends the force and damps the motion. May wait. False
    /// if the device doesn't obey. Called twice if the program's end takes long.
    [[nodiscard]] virtual bool brake() noexcept = 0;

protected:
    DeviceGuard() = default;
    DeviceGuard(const DeviceGuard&) = default;
    DeviceGuard& operator=(const DeviceGuard&) = default;
};

} // namespace tactus
