// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/haptic_device.hpp"
#include "platform/loop/clutch.hpp"
#include "rt_core/force/force_pipeline.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace tactus::hrtc
{

/// What a program adds to what surfaces do to one tool. It goes through all stages as theirs does.
class OwnForceSource
{
public:
    virtual ~OwnForceSource() = default;
    /// Once a frame, on the haptic thread: it must not block, allocate or throw. Where anything is
    /// no number there is no force at all.
    [[nodiscard]] virtual OwnForce next(const DeviceSample& sample, const ToolState& tool,
                                        const ToolOutput& output) noexcept = 0;

protected:
    OwnForceSource() = default;
    OwnForceSource(const OwnForceSource&) = default;
    OwnForceSource& operator=(const OwnForceSource&) = default;
};

/// One tool as the controller sets it up before the loop starts.
struct ToolSetup
{
    ToolSpec spec;             ///< The frame's part.
    std::string shape;         ///< In the words of --tool.
    std::string guide;         ///< In the words of --guide; empty: none.
    double hand_radius_m{0.0}; ///< How far from a surface a simulated hand holds it.
    std::unique_ptr<HapticDevice> device;
    SafetyLimits limits;
    ConditionerSetup conditioner;
    std::optional<std::uint32_t> clutch_button;
    OwnForceSource* own_force{nullptr}; ///< Lent; may be none.
    ToolLoad load;                      ///< Its weight no more than the device's largest force.
    ChangeRule change;
};

/// One tool on the haptic thread: its device, and the ForcePipeline between the frame and that. The
/// loop calls the methods of one period in this order:
///
///     read -> (frame) -> make_safe -> write
///
/// Haptic thread only, except brake(). Allocates nothing.
class ToolPort
{
public:
    /// `setup` outlives the port.
    explicit ToolPort(const ToolSetup& setup) noexcept;

    /// Reads the device. `periods`: whole periods since the last frame.
    [[nodiscard]] const ToolState& read(std::uint32_t periods) noexcept;

    /// Decides which force goes out. Releases the device's brake if somebody has braked it, unless
    /// brake() was called on this port.
    /// `context.force_left` is found here.
    const ToolForce& make_safe(const ToolOutput& output, PeriodContext context) noexcept;

    /// Sends the force that make_safe() has returned.
    void write() noexcept { send(pipeline_.force()); }

    /// What passed between it and the device in this period, beside the ToolState.
    [[nodiscard]] const DeviceRecord& record() const noexcept { return record_; }

    /// Sends the last force, faded by this much more time. It uses nothing but that force and the
    /// device's write, so it can be called in the middle of a frame that a bug has interrupted.
    void fade(double elapsed_s, ForceOff cause) noexcept { send(pipeline_.fade(elapsed_s, cause)); }

    /// The run is over: no force.
    void rest() noexcept { device_.write({}); }

    /// Any thread: brakes the device for good.
    void brake() noexcept;

private:
    void look() noexcept;
    [[nodiscard]] OwnForce own_force(const ToolOutput& output) noexcept;
    [[nodiscard]] double take_back() noexcept;
    void release_brake() noexcept;
    void send(const ToolForce& force) noexcept;

    HapticDevice& device_;
    Clutch clutch_;
    ForcePipeline pipeline_;
    OwnForceSource* own_source_;
    DeviceSample sample_;
    HandPlace hand_; ///< Of the last sample.
    ToolState state_;
    DeviceRecord record_;
    std::atomic<bool> is_braked_for_good_{false};
};

} // namespace tactus::hrtc
