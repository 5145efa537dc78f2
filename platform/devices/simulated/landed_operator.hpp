// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/devices/simulated/contact_slide.hpp"
#include "platform/devices/simulated/operator_motion.hpp"
#include "platform/devices/simulated/operator_pace.hpp"
#include "platform/devices/simulated/phasor.hpp"
#include "platform/devices/simulated/scripted_operator.hpp"

#include <cstdint>

namespace tactus
{

/// Descends straight from a gate to the place below it and from the first touch on moves around
/// that place, along its own axes. Without a contact it stops half a diagonal past the place. The
/// scene must suit ScriptedOperator.
class LandedOperator : public OperatorMotion
{
public:
    [[nodiscard]] Vec3 start_world_m() const noexcept override { return start_world_m_; }
    [[nodiscard]] Vec3 next_world_m(const OperatorSense& sense) noexcept override;

protected:
    explicit LandedOperator(const OperatorScene& scene);

    /// Offset from the place of the first touch, `seconds` later: x and y along the surface, z into
    /// it. Continuous, and 0 at 0 s. Once a frame.
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
    double device_speed_m_per_s_{0.0}; ///< Downward speed, over the last 10 ms or so.
    Vec3 start_world_m_;
    Vec3 down_;
    Vec3 across_;
    double length_m_; ///< Distance from the start to the place.
    double way_m_{0.0};
    Vec3 touched_world_m_{Vec3::Zero()};
    bool has_landed_{false};
    std::uint64_t frames_since_{0};
};

/// Presses within 0.3 s and rests.
class PressingOperator final : public LandedOperator
{
public:
    explicit PressingOperator(const OperatorScene& scene) : LandedOperator(scene) {}

private:
    [[nodiscard]] Vec3 offset_m(double seconds) noexcept override;
};

/// Two taps a second, between them three tool radii off the surface.
class TappingOperator final : public LandedOperator
{
public:
    explicit TappingOperator(const OperatorScene& scene);

private:
    [[nodiscard]] Vec3 offset_m(double seconds) noexcept override;

    double height_m_;
};

/// Presses and circles twice a second, a tenth of a diagonal wide.
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
