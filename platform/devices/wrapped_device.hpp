// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/haptic_device.hpp"
#include "rt_core/base/assert.hpp"

#include <memory>
#include <utility>

namespace tactus
{

/// Forwards all calls to another device. Base of wrappers that change one behaviour. Threads as in
/// HapticDevice.
class WrappedDevice : public HapticDevice
{
public:
    /// `device` is not null (asserted).
    explicit WrappedDevice(std::unique_ptr<HapticDevice> device) : device_(std::move(device))
    {
        TACTUS_ASSERT(device_ != nullptr);
    }

    [[nodiscard]] const DeviceInfo& info() const noexcept override { return device_->info(); }
    [[nodiscard]] DeviceSample read() noexcept override { return device_->read(); }
    void write(const Wrench& wrench) noexcept override { device_->write(wrench); }
    void brake() noexcept override { device_->brake(); }
    void brake_softly() noexcept override { device_->brake_softly(); }
    void release_brake() noexcept override { device_->release_brake(); }
    [[nodiscard]] DeviceStatus status() const noexcept override { return device_->status(); }

private:
    std::unique_ptr<HapticDevice> device_;
};

} // namespace tactus
