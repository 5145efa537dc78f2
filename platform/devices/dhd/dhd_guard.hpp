// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/device_guard.hpp"
#include "platform/devices/dhd/dhd_library.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <memory>
#include <string>

namespace tactus
{

/// Brakes a device that a DhdDevice of the dead program had opened. Only one program at a time can
/// open a device, so brake() waits until the system has closed it for the dead program.
class DhdGuard final : public DeviceGuard
{
public:
    /// Loads the SDK. `library` and `index` have the same meaning as in DhdDeviceOptions.
    [[nodiscard]] static Result<std::unique_ptr<DeviceGuard>, Refusal>
    create(const std::string& library, int index);

    /// Tries for up to two seconds to open the device, then brakes and closes it.
    [[nodiscard]] bool brake() noexcept override;

private:
    DhdGuard(DhdLibrary library, int index);

    const DhdLibrary library_;
    const char index_;
};

} // namespace tactus
