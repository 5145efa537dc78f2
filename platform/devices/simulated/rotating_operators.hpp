// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/simulated/contact_slide.hpp"
#include "platform/devices/simulated/landed_operator.hpp"
#include "platform/devices/simulated/motion_maths.hpp"
#include "platform/devices/simulated/operator_motion.hpp"
#include "platform/devices/simulated/scripted_operator.hpp"
#include "rt_core/math/rotation.hpp"

#include <cstdint>
#include <memory>

namespace tactus
{

/// Rotations of a wrist to and fro about the world's axes in turn: a swing goes from rest one way,
/// back, the other way, and to rest again. Arithmetic and square roots only.
class WristSwings
{
public:
    /// `axes`: number of axes to swing about, x first. `half_tangent`: tangent of half the largest
    /// angle.
    WristSwings(double half_tangent, double swings_per_s, int axes, double period_s) noexcept
        : half_tangent_(half_tangent), axes_(axes), phasor_(swings_per_s, period_s)
    {
    }

    /// Advances by one period.
    void step() noexcept
    {
        const bool was_back = phasor_.sin() < 0.0;
        phasor_.turn();
        axis_ = was_back && phasor_.sin() >= 0.0 ? (axis_ + 1) % axes_ : axis_;
    }

    /// Present rotation. The third power of the sine lets each swing start and end at rest.
    [[nodiscard]] Mat3 rotation() const noexcept
    {
        const double sine = phasor_.sin();
        return turned_by(Vec3::Unit(axis_) * (2.0 * half_tangent_ * sine * sine * sine),
                         Mat3::Identity());
    }

private:
    double half_tangent_;
    int axes_;
    int axis_{0};
    Phasor phasor_;
};

/// Presses like PressingOperator. Rotates the tool about the world's x, y and z axes in turn, 30
/// degrees to and fro, 2 s for each axis.
class RotatingOperator final : public LandedOperator
{
public:
    explicit RotatingOperator(const OperatorScene& scene);
    [[nodiscard]] OperatorGrip grip() const noexcept override;

private:
    [[nodiscard]] Vec3 offset_m(double seconds) noexcept override;

    WristSwings swings_;
};

/// Follows the path of `way` and rotates the tool with the surface, whose normal is the direction
/// of the felt force. The tool rotates at up to 4 rad/s.
class EdgeOperator final : public OperatorMotion
{
public:
    EdgeOperator(std::unique_ptr<OperatorMotion> way, const OperatorScene& scene);
    [[nodiscard]] Vec3 start_world_m() const noexcept override { return way_->start_world_m(); }
    [[nodiscard]] Vec3 next_world_m(const OperatorSense& sense) noexcept override;
    [[nodiscard]] OperatorGrip grip() const noexcept override;

private:
    void turn_with(const Vec3& felt) noexcept;

    std::unique_ptr<OperatorMotion> way_;
    ContactSlide feeling_; ///< Detects touches.
    double period_s_;
    bool has_touched_{false};
    Vec3 normal_{Vec3::UnitZ()}; ///< Normal that the tool follows, at its initial angle to it.
    Mat3 rotation_{Mat3::Identity()};
};

/// Operator that moves the tool like a peg in a hole. It descends along the world's z through the
/// middle of the model, until the force on the hand is about 1 N. Then it tilts the tool by 2
/// degrees about x and y, and withdraws it by a sixth of a diagonal. There, for 0.6 s, it presses
/// button 0, opens the gripper, and moves up and back. Then it descends again. Without a contact it
/// reverses half a diagonal below the middle.
class PegOperator final : public OperatorMotion
{
public:
    explicit PegOperator(const OperatorScene& scene);
    [[nodiscard]] Vec3 start_world_m() const noexcept override { return start_world_m_; }
    [[nodiscard]] Vec3 next_world_m(const OperatorSense& sense) noexcept override;
    [[nodiscard]] OperatorGrip grip() const noexcept override;

private:
    enum class Phase : std::uint8_t
    {
        in,
        tilt,
        out,
        change_grip,
    };

    void enter(Phase phase) noexcept;
    void go_in(const OperatorSense& sense) noexcept;
    [[nodiscard]] bool is_over(double seconds) const noexcept;

    double period_s_;
    double diagonal_m_;
    double press_n_;
    double speed_m_per_s_;
    Vec3 start_world_m_;
    double way_max_m_;
    WristSwings swings_;
    Phase phase_{Phase::in};
    double in_phase_s_{0.0};
    double pressed_s_{0.0};
    double way_m_{0.0};     ///< Distance down from the start.
    double deepest_m_{0.0}; ///< Largest depth of this descent.
};

} // namespace tactus
