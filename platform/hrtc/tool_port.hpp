// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/haptic_device.hpp"
#include "platform/hrtc/cycle_measures.hpp"
#include "platform/hrtc/jump_watch.hpp"
#include "rt_core/force/force_conditioner.hpp"
#include "rt_core/force/safe_state.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>

namespace tactus::hrtc
{

/// One tool as the controller sets it up before the loop starts.
struct ToolSetup
{
    ToolSpec spec; ///< The frame's part.
    std::unique_ptr<HapticDevice> device;
    SafetyLimits limits;
    ConditionerSetup conditioner;
};

/// What the loop knows about the present period and a port cannot see.
struct PeriodContext
{
    double elapsed_s{0.0}; ///< True time since the last frame.
    ForceOff causes{ForceOff::none};
};

/// One tool on the haptic thread: its device, and everything between the frame's force and that
/// device. The loop calls the methods of one period in this order:
///
///     read -> see_objects -> (frame) -> make_safe -> write
///
/// Haptic thread only, except brake(). Allocates nothing.
class ToolPort
{
public:
    /// `setup` outlives the port.
    explicit ToolPort(const ToolSetup& setup) noexcept;

    /// Reads the device. `periods`: whole periods since the last frame.
    [[nodiscard]] const ToolState& read(std::uint32_t periods) noexcept;

    /// Compares where the objects stand in the coming frame with the frame before.
    void see_objects(std::span<const ObjectPose> before, std::span<const ObjectPose> now) noexcept
    {
        jump_.see(before, now);
    }

    /// Decides which force goes out. Releases the device's brake if somebody has braked it, unless
    /// brake() was called on this port.
    [[nodiscard]] SafetyOutput make_safe(const ToolOutput& output,
                                         const PeriodContext& context) noexcept;

    void write() noexcept { send(force_.sent_n); }

    /// The force that write() sends, and how it came about.
    [[nodiscard]] const ToolForce& force() const noexcept { return force_; }

    /// Sends the last force, faded by this much more time. It uses nothing but that force and the
    /// device's write, so it can be called in the middle of a frame that a bug has interrupted.
    void fade(double elapsed_s, ForceOff cause) noexcept
    {
        send(safe_state_.fade(elapsed_s, cause).force_n);
    }

    /// The run is over: no force.
    void rest() noexcept { send(Vec3(0.0, 0.0, 0.0)); }

    /// Any thread: brakes the device for good.
    void brake() noexcept;

private:
    [[nodiscard]] ForceWish wish_of(const ToolOutput& output) const noexcept;
    [[nodiscard]] SafetyInput safety_input(const ToolOutput& output,
                                           const PeriodContext& context) noexcept;
    [[nodiscard]] ForceOff own_causes() const noexcept;
    [[nodiscard]] bool take_back() noexcept;
    void release_brake() noexcept;
    void send(const Vec3& force_n) noexcept;

    HapticDevice& device_;
    ForceConditioner conditioner_;
    SafeState safe_state_;
    JumpWatch jump_;
    DeviceSample sample_;
    ToolState state_;
    ToolForce force_;
    std::atomic<bool> is_braked_for_good_{false};
};

} // namespace tactus::hrtc
