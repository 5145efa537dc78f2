// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/haptic_device.hpp"
#include "rt_core/force/force_pipeline.hpp"
#include "rt_core/math/rotation.hpp"
#include "rt_core/records/device_record.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace tactus::hrtc
{

/// Button that decouples the tool from the device. While it is held the tool stays and the device
/// moves freely; after its release the tool follows the device again, from the tool's present pose.
/// So a small workspace reaches far. Haptic thread.
class Clutch
{
public:
    /// `button`: number of the button; none: no clutch, and the tool has the device's pose.
    explicit Clutch(std::optional<std::uint32_t> button) noexcept : button_(button) {}

    /// Pose of the tool for this device pose and these buttons, one bit a button. Both rotations
    /// are orthonormal to kRotationTolerance.
    [[nodiscard]] DevicePose tool_at(const DevicePose& device, std::uint32_t buttons) noexcept
    {
        const bool was_held = is_held_;
        is_held_ = button_ && ((buttons >> *button_) & 1U) != 0;
        if (!is_held_ && was_held)
        {
            offset_m_ = tool_.position_m - device.position_m;
            rotation_ = orthonormalised(device.rotation.transpose() * tool_.rotation);
        }
        has_parted_ = has_parted_ || is_held_;
        if (!is_held_ || !has_tool_)
        {
            tool_ = moved(device);
        }
        has_tool_ = true;
        return tool_;
    }

    [[nodiscard]] bool is_held() const noexcept { return is_held_; }
    /// True once the button has been held; device and tool poses differ from then on.
    [[nodiscard]] bool has_parted() const noexcept { return has_parted_; }

private:
    [[nodiscard]] DevicePose moved(const DevicePose& device) const noexcept
    {
        return has_parted_ ? DevicePose{device.position_m + offset_m_, device.rotation * rotation_}
                           : device;
    }

    std::optional<std::uint32_t> button_;
    bool is_held_{false};
    bool has_parted_{false};
    Vec3 offset_m_{0.0, 0.0, 0.0};    ///< Offset from device to tool, in the world.
    Mat3 rotation_{Mat3::Identity()}; ///< Rotation of the tool in the device's frame.
    DevicePose tool_;                 ///< Pose that tool_at() returned last.
    bool has_tool_{false};
};

/// Source of an external force, which a program adds to the contact forces of one tool. The sum
/// passes all stages of ForcePipeline.
class ExternalForceSource
{
public:
    virtual ~ExternalForceSource() = default;
    /// Force of this frame. Haptic thread: must not block, allocate or throw. If any component is
    /// not a number, the whole force is zero.
    [[nodiscard]] virtual ExternalForce next(const DeviceSample& sample, const ToolState& tool,
                                             const ToolOutput& output) noexcept = 0;

protected:
    ExternalForceSource() = default;
    ExternalForceSource(const ExternalForceSource&) = default;
    ExternalForceSource& operator=(const ExternalForceSource&) = default;
};

/// Setup of one tool, complete before the loop starts.
struct ToolSetup
{
    ToolSpec spec;       ///< Tool of the frame.
    std::string shape;   ///< Shape as given by --tool.
    std::string fixture; ///< Virtual fixture as given by --fixture; empty: none.
    /// Distance of the tool's origin from a surface that a simulated operator touches.
    double operator_radius_m{0.0};
    std::unique_ptr<HapticDevice> device;
    SafetyLimits limits;
    ConditionerSetup conditioner;
    std::optional<std::uint32_t> clutch_button;
    ExternalForceSource* external_force{
        nullptr};  ///< Source of an external force; borrowed, may be null.
    ToolLoad load; ///< Payload; its weight must not exceed the device's largest force.
    ChangeRule change;
};

/// One tool on the haptic thread: its device, and the ForcePipeline between the frame and the
/// device. The loop calls the methods of one period in this order:
///
///     read -> (frame) -> make_safe -> write
///
/// Haptic thread only, except brake(). Allocates nothing.
class ToolPort
{
public:
    /// `setup` outlives the port.
    explicit ToolPort(const ToolSetup& setup) noexcept;

    /// Reads the device and returns the tool's state. `periods`: whole periods since the last
    /// frame.
    [[nodiscard]] const ToolState& read(std::uint32_t periods) noexcept;

    /// Determines the force to send, valid until the next call. Releases the device's brake if
    /// another thread has braked the device, unless brake() was called on this port. Overwrites
    /// `context.force_left`.
    const ToolForce& make_safe(const ToolOutput& output, PeriodContext context) noexcept;

    /// Sends the force that make_safe() has returned.
    void write() noexcept { send(pipeline_.force()); }

    /// Data exchanged with the device in this period that the ToolState lacks.
    [[nodiscard]] const DeviceRecord& record() const noexcept { return record_; }

    /// Sends the last force, faded by `elapsed_s` more. It uses only that force and the device's
    /// write, so it may be called in the middle of a frame that a bug has interrupted.
    void fade(double elapsed_s, ForceOff cause) noexcept { send(pipeline_.fade(elapsed_s, cause)); }

    /// Sends zero force at the end of the run.
    void rest() noexcept { device_.write({}); }

    /// Any thread: brakes the device permanently.
    void brake() noexcept;

private:
    void record_sample() noexcept;
    [[nodiscard]] ExternalForce external_force(const ToolOutput& output) noexcept;
    [[nodiscard]] double take_back() noexcept;
    void release_brake() noexcept;
    void send(const ToolForce& force) noexcept;

    HapticDevice& device_;
    Clutch clutch_;
    ForcePipeline pipeline_;
    ExternalForceSource* external_source_;
    DeviceSample sample_;
    DevicePose pose_; ///< Device pose of the last sample.
    ToolState state_;
    DeviceRecord record_;
    std::atomic<bool> is_braked_for_good_{false};
};

} // namespace tactus::hrtc
