// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus
{

/// The other end of a device, in a process of its own: what takes the force away when the program
/// that drives the device has died without doing so. It is made before the device is opened, and
/// holds all that its brake() needs, since by then there may be no memory and no file to be had.
/// For the one thread of that process.
class DeviceGuard
{
public:
    virtual ~DeviceGuard() = default;

    /// The program has died, or is about to: the force ends and the motion is damped. It may wait.
    /// False where the device doesn't obey. Called twice where the program's end takes long.
    [[nodiscard]] virtual bool brake() noexcept = 0;

protected:
    DeviceGuard() = default;
    DeviceGuard(const DeviceGuard&) = default;
    DeviceGuard& operator=(const DeviceGuard&) = default;
};

} // namespace tactus
