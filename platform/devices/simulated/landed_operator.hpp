// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/simulated/contact_slide.hpp"
#include "platform/devices/simulated/motion_maths.hpp"
#include "platform/devices/simulated/operator_motion.hpp"
#include "platform/devices/simulated/operator_pace.hpp"
#include "platform/devices/simulated/scripted_operator.hpp"

#include <cstdint>

namespace tactus
{

/// Operator that descends straight from the gate of a landing site to its aim. After the first
/// touch it moves around the point of touch, along its own axes. Without a touch it stops half a
/// diagonal past the aim. The scene must pass the checks of ScriptedOperator::create().
class LandedOperator : public OperatorMotion
{
public:
    [[nodiscard]] Vec3 start_world_m() const noexcept override { return start_world_m_; }
    [[nodiscard]] Vec3 next_world_m(const OperatorSense& sense) noexcept override;

protected:
    explicit LandedOperator(const OperatorScene& scene);

    /// Offset from the point of the first touch, `seconds` after the touch: z along the descent, x
    /// and y perpendicular to it. Must be continuous, and 0 at 0 s. Called once a frame.
    [[nodiscard]] virtual Vec3 offset_m(double seconds) noexcept = 0;
    /// Depth at which the default device and hand make about 1 N on a wall of 500 N/m.
    [[nodiscard]] double press_m() const noexcept { return press_m_; }

private:
    [[nodiscard]] bool has_met_something(const OperatorSense& sense, double left_m,
                                         double speed_m_per_s) noexcept;

    double period_s_;
    double diagonal_m_;
    double tool_radius_m_;
    double press_m_;
    OperatorPace pace_;
    ContactSlide feeling_; ///< Detects touches.
    Vec3 last_device_world_m_;
    double device_speed_m_per_s_{0.0}; ///< Speed along `down_`, low-pass filtered over 10 ms.
    Vec3 start_world_m_;
    Vec3 down_;
    Vec3 across_;
    double length_m_; ///< Distance from the start to the aim.
    double way_m_{0.0};
    Vec3 touched_world_m_{Vec3::Zero()};
    bool has_landed_{false};
    std::uint64_t frames_since_{0};
};

/// Presses into the surface within 0.3 s of the touch, and rests there.
class PressingOperator final : public LandedOperator
{
public:
    explicit PressingOperator(const OperatorScene& scene) : LandedOperator(scene) {}

private:
    [[nodiscard]] Vec3 offset_m(double seconds) noexcept override;
};

/// Taps twice a second; rises to three tool radii above the surface between taps.
class TappingOperator final : public LandedOperator
{
public:
    explicit TappingOperator(const OperatorScene& scene);

private:
    [[nodiscard]] Vec3 offset_m(double seconds) noexcept override;

    double height_m_;
};

/// Presses, and moves twice a second round a circle a tenth of a diagonal wide.
class SpinningOperator final : public LandedOperator
{
public:
    explicit SpinningOperator(const OperatorScene& scene);

private:
    [[nodiscard]] Vec3 offset_m(double seconds) noexcept override;

    double radius_m_;
    Phasor phasor_;
};

} // namespace tactus
