// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/base/refusal.hpp"
#include "platform/haptic_device.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/math/vec3.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace tactus
{

/// One reading of a device as it was recorded.
struct RecordedReading
{
    Vec3 position_world_m{Vec3::Zero()};
    MonotonicTime time; ///< Of the device's clock then.
    bool valid{true};
};

struct ReplayDeviceOptions
{
    std::vector<RecordedReading> readings; ///< At least one.
    std::int64_t rate_hz{1'000};           ///< That they were made at; above zero.
    DeviceLimits limits;                   ///< What it says of itself.
    double speed_max_m_per_s{10.0};        ///< Finite and above zero.
};

/// A hand that was recorded: reading k is the recorded reading k, whatever force is written, how
/// late the reading comes, and where the recorded position was no number or not valid. The force is
/// taken as by any device, but moves nothing. After the last reading it is disconnected, at its
/// last place; its readings still count. The velocity isn't told.
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
    void write(const std::array<double, 3>& force_world_n) noexcept override;
    void brake() noexcept override { braked_.store(true); }
    void release_brake() noexcept override;
    [[nodiscard]] DeviceStatus status() const noexcept override;

private:
    explicit ReplayDevice(ReplayDeviceOptions options);

    [[nodiscard]] bool has_ended() const noexcept { return status_.frames > readings_.size(); }

    std::vector<RecordedReading> readings_;
    DeviceInfo info_;
    DeviceStatus status_;
    /// The one field that other threads write. Sequentially consistent: it is rare and orders
    /// nothing else.
    std::atomic<bool> braked_{false};
};

} // namespace tactus
