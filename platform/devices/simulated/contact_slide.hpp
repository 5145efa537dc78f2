// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/simulated/operator_motion.hpp"
#include "rt_core/math/vec3.hpp"

#include <cstdint>

namespace tactus
{

/// Motion of a simulated hand along a surface that is known only by its contact force. The hand
/// moves perpendicular to the felt force, changes its heading slowly, and presses so that the felt
/// force follows a set value.
///
///     felt force ^   heading -->            pressing: an integrating controller on |force|;
///                |  /                       its output is a limited speed, so that it does not
///       ---------(o)--------- surface       wind up without resistance.
///                 |  pressing
///                 v
///
/// On a curved surface the deeper hand moves on another radius than the device; a slow correction
/// of its speed keeps the device at the set speed.
class ContactSlide
{
public:
    ContactSlide(double diagonal_m, double period_s) noexcept;

    /// Starts a slide; is_touching(sense) must hold (asserted). `heading_hint` is a direction in
    /// the world; its part along the surface becomes the heading.
    void begin(const OperatorSense& sense, const Vec3& heading_hint) noexcept;

    /// Velocity of the hand in this frame, in m/s.
    [[nodiscard]] Vec3 next_velocity(const OperatorSense& sense) noexcept;

    void turn_round() noexcept;

    [[nodiscard]] bool is_touching(const OperatorSense& sense) const noexcept;
    /// True if damping alone, at landing speeds, can't cause this force.
    [[nodiscard]] bool is_firm(const OperatorSense& sense) const noexcept;
    /// Normal out of the surface, of unit length.
    [[nodiscard]] const Vec3& normal() const noexcept { return normal_; }
    [[nodiscard]] const Vec3& heading() const noexcept { return heading_; }
    /// Time since the last felt force; 0 while in contact.
    [[nodiscard]] double untouched_s() const noexcept { return untouched_s_; }
    /// Duration of uninterrupted contact since begin().
    [[nodiscard]] double touched_s() const noexcept { return touched_s_; }

private:
    [[nodiscard]] double wanted_force_n() const noexcept;
    [[nodiscard]] Vec3 press(double force_n) const noexcept;
    void follow_surface(const OperatorSense& sense, double force_n) noexcept;
    void correct_speed(const OperatorSense& sense) noexcept;
    void turn_round_when_stuck() noexcept;

    double period_s_;
    double speed_m_per_s_;
    double force_n_;
    double press_speed_max_m_per_s_;

    Vec3 normal_{Vec3::UnitZ()};
    Vec3 heading_{Vec3::UnitX()};
    Vec3 last_device_world_m_{Vec3::Zero()};
    double device_speed_m_per_s_{0.0};
    double speed_factor_{1.0};
    double untouched_s_{0.0};
    double touched_s_{0.0};
    double stuck_s_{0.0};
    std::uint64_t frames_{0};
};

} // namespace tactus
