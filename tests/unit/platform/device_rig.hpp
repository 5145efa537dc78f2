// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/device_force.hpp"
#include "platform/devices/haptic_device.hpp"
#include "platform/devices/simulated/device_classes.hpp"
#include "platform/devices/simulated/faulty_device.hpp"
#include "platform/devices/simulated/operator_motion.hpp"
#include "platform/devices/simulated/replay_device.hpp"
#include "platform/devices/simulated/simulated_device.hpp"

#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace tactus::test
{

/// Hand at the origin.
struct OperatorAtRest final : OperatorMotion
{
    [[nodiscard]] Vec3 start_world_m() const noexcept override { return Vec3::Zero(); }
    [[nodiscard]] Vec3 next_world_m(const OperatorSense&) noexcept override { return Vec3::Zero(); }
};

/// Hand whose place is a law of the frame; it begins at the origin.
struct OperatorByLaw final : OperatorMotion
{
    explicit OperatorByLaw(std::function<Vec3(double frame)> place_m) : law_m(std::move(place_m)) {}
    [[nodiscard]] Vec3 start_world_m() const noexcept override { return Vec3::Zero(); }
    [[nodiscard]] Vec3 next_world_m(const OperatorSense& sense) noexcept override
    {
        return law_m(static_cast<double>(sense.frame));
    }

    std::function<Vec3(double frame)> law_m;
};

/// Hand that moves at constant speed along x, by `step_m` each period.
inline std::unique_ptr<OperatorMotion> operator_along_x(double step_m)
{
    return std::make_unique<OperatorByLaw>([=](double frame)
                                           { return Vec3(step_m * frame, 0.0, 0.0); });
}

/// Device under test, with a hand that holds it loosely at one place, and controlled time: nothing
/// happens between two calls of next().
struct DeviceRig
{
    virtual ~DeviceRig() = default;
    [[nodiscard]] virtual HapticDevice& device() noexcept = 0;
    /// Advances one period under the last written force, then reads once.
    [[nodiscard]] virtual DeviceSample next() = 0;
    /// True if the hand yields to a force; otherwise it never moves.
    [[nodiscard]] virtual bool gives_way() const { return true; }
    /// True if it also yields to a torque.
    [[nodiscard]] virtual bool turns() const { return gives_way(); }

protected:
    DeviceRig() = default;
    DeviceRig(const DeviceRig&) = default;
    DeviceRig& operator=(const DeviceRig&) = default;
};

/// Simulated device of any class; its wrapper must keep its promises too.
struct SimulatedRig final : DeviceRig
{
    explicit SimulatedRig(const DeviceLimits& limits = kDeskClass)
    {
        SimulatedDeviceOptions options;
        options.device = limits;
        auto made = SimulatedDevice::create(options, std::make_unique<OperatorAtRest>());
        device_ = std::make_unique<FaultyDevice>(std::move(made).value(), faults_);
    }
    [[nodiscard]] HapticDevice& device() noexcept override { return *device_; }
    [[nodiscard]] DeviceSample next() override { return device_->read(); }

private:
    /// The time is after all tests.
    std::vector<DeviceFault> faults_{{DeviceFaultKind::nan, 1'000'000, 1}};
    std::unique_ptr<FaultyDevice> device_;
};

/// Rig with a recording of a hand at rest.
struct ReplayRig final : DeviceRig
{
    [[nodiscard]] HapticDevice& device() noexcept override { return *device_; }
    [[nodiscard]] DeviceSample next() override { return device_->read(); }
    [[nodiscard]] bool gives_way() const override { return false; }

private:
    static ReplayDeviceOptions hand_at_rest()
    {
        ReplayDeviceOptions options;
        options.limits = kDeskClass;
        for (std::int64_t i = 0; i < 1'000; ++i)
        {
            DeviceSample reading;
            reading.position_world_m = {0.1, 0.2, 0.3};
            reading.time = MonotonicTime{i * 1'000'000};
            reading.valid = true;
            reading.rotation_world = {0.0, 0.0, 0.0, 1.0};
            options.readings.push_back(reading);
        }
        return options;
    }

    std::unique_ptr<ReplayDevice> device_ = std::move(ReplayDevice::create(hand_at_rest())).value();
};

} // namespace tactus::test
