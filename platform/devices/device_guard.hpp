// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus
{

/// Ends a device's force if the program that drives the device dies. Runs in the guardian, a
/// process of its own, on its one thread. Create a guard before the device is opened. The
/// constructor acquires all resources of brake(), since memory or files may be unavailable after
/// the death.
class DeviceGuard
{
public:
    virtual ~DeviceGuard() = default;

    /// Ends the force and damps the motion, once the program has died or is dying. May wait.
    /// Returns false if the device doesn't obey. A second call follows if the program takes long to
    /// end.
    [[nodiscard]] virtual bool brake() noexcept = 0;

protected:
    DeviceGuard() = default;
    DeviceGuard(const DeviceGuard&) = default;
    DeviceGuard& operator=(const DeviceGuard&) = default;
};

} // namespace tactus
