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

/// Brakes a device that DhdDevice had opened. Only one program at a time can open it, so brake()
/// opens it as soon as the system has closed it for the dead one.
class DhdGuard final : public DeviceGuard
{
public:
    /// Loads the SDK. The path and the index are those of DhdDeviceOptions.
    [[nodiscard]] static Result<std::unique_ptr<DeviceGuard>, Refusal>
    create(const std::string& library, int index);

    /// Tries for up to two seconds to open the device.
    [[nodiscard]] bool brake() noexcept override;

private:
    DhdGuard(DhdLibrary library, int index);

    const DhdLibrary library_;
    const char index_;
};

} // namespace tactus
