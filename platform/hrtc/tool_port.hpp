// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/haptic_device.hpp"
#include "platform/hrtc/clutch.hpp"
#include "platform/hrtc/cycle_measures.hpp"
#include "rt_core/force/force_conditioner.hpp"
#include "rt_core/force/gravity_compensation.hpp"
#include "rt_core/force/own_force.hpp"
#include "rt_core/force/safe_state.hpp"
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

/// What a program adds to what surfaces do to one tool. It goes through cap, clamp, passivity and
/// SafeState as theirs does.
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
};

/// What the loop knows about the present period and a port cannot see.
struct PeriodContext
{
    double elapsed_s{0.0}; ///< True time since the last frame.
    ForceOff causes{ForceOff::none};
    double surface_damping_n_s_per_m{0.0}; ///< ForceWish's.
};

/// One tool on the haptic thread: its device, and everything between the frame's force and that
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

    /// Reads the device. `periods`: whole periods since the last frame.
    [[nodiscard]] const ToolState& read(std::uint32_t periods) noexcept;

    /// Decides which force goes out. Releases the device's brake if somebody has braked it, unless
    /// brake() was called on this port.
    [[nodiscard]] SafetyOutput make_safe(const ToolOutput& output,
                                         const PeriodContext& context) noexcept;

    void write() noexcept
    {
        send({force_.sent_n, force_.sent_nm, force_.load_n, force_.load_nm}, force_.sent_gripper_n);
    }

    /// The force that write() sends, and how it came about.
    [[nodiscard]] const ToolForce& force() const noexcept { return force_; }

    /// What passed between it and the device in this period, beside the ToolState.
    [[nodiscard]] DeviceRecord record() const noexcept;

    /// Sends the last force, faded by this much more time. It uses nothing but that force and the
    /// device's write, so it can be called in the middle of a frame that a bug has interrupted.
    void fade(double elapsed_s, ForceOff cause) noexcept
    {
        const SafetyOutput safe = safe_state_.fade(elapsed_s, cause);
        send(carry(safe, elapsed_s, 1.0), safe_state_.gain() * gripper_n_);
    }

    /// The run is over: no force.
    void rest() noexcept { device_.write({}); }

    /// Any thread: brakes the device for good.
    void brake() noexcept;

private:
    [[nodiscard]] WrenchWish wish_of(const ToolOutput& output,
                                     double surface_damping_n_s_per_m) const noexcept;
    [[nodiscard]] SafetyInput safety_input(const ToolOutput& output,
                                           const PeriodContext& context) noexcept;
    [[nodiscard]] Vec3 twist_of(const ToolOutput& output) const noexcept;
    void turn_hand(const Mat3& rotation) noexcept;
    [[nodiscard]] OwnForce own_force(const ToolOutput& output) noexcept;
    [[nodiscard]] ForceOff own_causes() const noexcept;
    [[nodiscard]] double take_back() noexcept;
    void release_brake() noexcept;
    [[nodiscard]] LoadedWrench carry(const SafetyOutput& safe, double elapsed_s,
                                     double force_left) noexcept;
    void send(const LoadedWrench& wrench, double gripper_n) noexcept;

    HapticDevice& device_;
    Clutch clutch_;
    WrenchConditioner conditioner_;
    SafeState safe_state_;
    GravityCompensation gravity_;
    OwnForceSource* own_source_;
    double gripper_n_{0.0}; ///< Wanted by the last frame in which nothing was wrong.
    DeviceSample sample_;
    HandPlace hand_;                 ///< Of the last sample.
    Vec3 turned_rad_{0.0, 0.0, 0.0}; ///< By the hand, about the world's axes, summed up.
    /// Of a touched object's stiffness: the spring that turns is softened with the one that pushes.
    double angular_share_m2_;
    ToolState state_;
    ToolForce force_;
    std::atomic<bool> is_braked_for_good_{false};
};

} // namespace tactus::hrtc
