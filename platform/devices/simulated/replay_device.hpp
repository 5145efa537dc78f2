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

/// Readings to replay, and what the device reports about itself.
struct ReplayDeviceOptions
{
    /// Recorded readings, at least one; `frame` is renumbered.
    std::vector<DeviceSample> readings;
    std::int64_t rate_hz{1'000};    ///< Rate of the readings; above zero.
    DeviceLimits limits;            ///< Limits reported in info().
    double speed_max_m_per_s{10.0}; ///< Reported in info(); finite, above zero.
};

/// A device that replays recorded readings: reading k is recorded reading k, independent of forces
/// and time. Forces and torques are accepted, but move nothing. After the last recorded reading the
/// device is disconnected and keeps its last position; later readings are still numbered.
///
/// All readings are in memory from the start, so read() only copies one.
class ReplayDevice final : public HapticDevice
{
public:
    /// Least radius of the workspace, for recordings of a hand at rest.
    static constexpr double kReachMin_m = 1e-3;

    /// Refuses readings without any valid position, a rate that is not above zero, and a largest
    /// force or speed that is not finite and above zero.
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
    /// Written by other threads, too. Sequentially consistent: it is rare and orders nothing else.
    std::atomic<bool> braked_{false};
};

} // namespace tactus
