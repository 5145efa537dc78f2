// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

namespace tactus
{

/// A point that rotates on the unit circle by the same angle each frame. The step is a rational
/// rotation by the tangent of half the angle, so it needs no trigonometry and gives the same bits
/// everywhere; the radius stays 1 to rounding.
class Phasor
{
public:
    Phasor() = default;
    /// `turns_per_s`: turns a second, at most a tenth of a turn a period; there the rotation is 0.2
    /// % slow.
    Phasor(double turns_per_s, double period_s) noexcept
    {
        constexpr double kPi = 3.14159265358979324;
        const double half_angle = kPi * turns_per_s * period_s;
        const double t = half_angle + half_angle * half_angle * half_angle / 3.0;
        cos_step_ = (1.0 - t * t) / (1.0 + t * t);
        sin_step_ = 2.0 * t / (1.0 + t * t);
    }

    void turn() noexcept
    {
        const double cos_before = cos_;
        cos_ = cos_before * cos_step_ - sin_ * sin_step_;
        sin_ = cos_before * sin_step_ + sin_ * cos_step_;
    }

    /// Cosine; 1 at the start.
    [[nodiscard]] double cos() const noexcept { return cos_; }
    /// Sine; 0 at the start.
    [[nodiscard]] double sin() const noexcept { return sin_; }

private:
    double cos_step_{1.0};
    double sin_step_{0.0};
    double cos_{1.0};
    double sin_{0.0};
};

} // namespace tactus
