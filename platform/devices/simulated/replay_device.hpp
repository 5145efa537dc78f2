// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/haptic_device.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/math/vec3.hpp"
#include "transport/base/refusal.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace tactus
{

struct ReplayDeviceOptions
{
    /// As the device gave them then, at least one; their count is made anew.
    std::vector<DeviceSample> readings;
    std::int64_t rate_hz{1'000};    ///< That they were made at; above zero.
    DeviceLimits limits;            ///< What it says of itself.
    double speed_max_m_per_s{10.0}; ///< Finite and above zero.
};

/// A hand that was recorded: reading k is the recorded reading k, whatever force is written, how
/// late the reading comes, and where the recorded position was no number or not valid. Forces and
/// torques are taken as by any device, but move nothing. After the last reading it is disconnected,
/// at its last place; its readings still count.
///
/// All readings are in memory from the start: read() takes one and no more.
class ReplayDevice final : public HapticDevice
{
public:
    /// Of the workspace at least, so that a hand at rest has one.
    static constexpr double kReachMin_m = 1e-3;

    /// Refuses readings of which none is a place, a rate that isn't above zero, a largest force or
    /// speed that isn't finite and above zero.
    [[nodiscard]] static Result<std::unique_ptr<ReplayDevice>, Refusal>
    create(ReplayDeviceOptions options);

    [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
    [[nodiscard]] DeviceSample read() noexcept override;
    void write(const Wrench& wrench) noexcept override;
    void brake() noexcept override { braked_.store(true); }
    void release_brake() noexcept override;
    [[nodiscard]] DeviceStatus status() const noexcept override;

private:
    explicit ReplayDevice(ReplayDeviceOptions options);

    [[nodiscard]] bool has_ended() const noexcept { return status_.frames > readings_.size(); }

    std::vector<DeviceSample> readings_;
    DeviceInfo info_;
    DeviceStatus status_;
    /// The one field that other threads write. Sequentially consistent: it is rare and orders
    /// nothing else.
    std::atomic<bool> braked_{false};
};

} // namespace tactus
