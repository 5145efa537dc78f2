// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/dhd/dhd_device.hpp"
#include "platform/machine/posix/posix_clock.hpp"
#include "tests/unit/platform/device_rig.hpp"
#include "tests/unit/platform/stand_in_dhd.hpp"
#include "tests/unit/platform/udp_rig.hpp"

#include <gtest/gtest.h>

#include <dlfcn.h>
#include <thread>

namespace tactus::test
{

/// Stand-in library that DhdDevice also finds: one library of one path is loaded once.
struct LoadedStandIn
{
    LoadedStandIn() : handle_(dlopen(TACTUS_STAND_IN_DHD, RTLD_NOW | RTLD_LOCAL))
    {
        EXPECT_NE(handle_, nullptr);
        stand_in_ = reinterpret_cast<StandInDhdFunction*>(dlsym(handle_, kStandInDhdName))();
    }
    LoadedStandIn(const LoadedStandIn&) = delete;
    LoadedStandIn& operator=(const LoadedStandIn&) = delete;
    ~LoadedStandIn() { dlclose(handle_); }

    [[nodiscard]] StandInDhd* operator->() const noexcept { return stand_in_; }

private:
    void* handle_;
    StandInDhd* stand_in_{nullptr};
};

/// Waits until two turns of the device's thread have begun, with a whole one between.
inline void await_turn(const StandInDhdDevice& hand)
{
    const std::uint64_t now = hand.reads;
    while (hand.reads < now + 2)
    {
        std::this_thread::yield();
    }
}

/// DhdDevice on the stand-in, in lock step.
struct DhdRig final : DeviceRig
{
    DhdRig()
    {
        DhdDeviceOptions options;
        options.library = TACTUS_STAND_IN_DHD;
        options.period = DhdDeviceOptions::kPeriodMin;
        options.times = patient_times();
        options.clock = &clock_;
        while (stand_in_->devices.at(index_).is_open)
        {
            ++index_; // Index of another rig.
        }
        options.index = static_cast<int>(index_);
        device_ = std::move(DhdDevice::create(options)).value();
    }

    [[nodiscard]] HapticDevice& device() noexcept override { return *device_; }
    [[nodiscard]] DeviceSample next() override
    {
        await_turn(hand());
        hand().step();
        await_turn(hand());
        return device_->read();
    }
    [[nodiscard]] bool turns() const override { return false; }
    [[nodiscard]] StandInDhdDevice& hand() { return stand_in_->devices.at(index_); }

private:
    PosixClock clock_;
    LoadedStandIn stand_in_;
    std::size_t index_{0};
    std::unique_ptr<DhdDevice> device_;
};

} // namespace tactus::test
