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
#include <string>

namespace tactus::hrtc
{

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
