// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"

#include <Eigen/Geometry>

#include <cstdint>

namespace tactus
{

/// Unit vector, or zero for the zero vector.
[[nodiscard]] inline Vec3 direction_or_zero(const Vec3& v) noexcept
{
    const double length = v.norm();
    return length > 0.0 ? Vec3(v / length) : Vec3(Vec3::Zero());
}

/// Unit vector perpendicular to `direction`, a function of it alone; `direction` must not be zero.
[[nodiscard]] inline Vec3 any_across(const Vec3& direction) noexcept
{
    int least = 0;
    direction.cwiseAbs().minCoeff(&least);
    return direction.cross(Vec3::Unit(least)).normalized();
}

/// Component of `v` perpendicular to the unit vector `direction`.
[[nodiscard]] inline Vec3 part_across(const Vec3& v, const Vec3& direction) noexcept
{
    return v - direction * v.dot(direction);
}

/// Mixed bits of a counter: SplitMix64 (Steele, Lea and Flood 2014). Stateless, so noise depends
/// only on the frame's index.
[[nodiscard]] constexpr std::uint64_t mix_bits(std::uint64_t counter) noexcept
{
    std::uint64_t bits = (counter + 1) * 0x9e3779b97f4a7c15U;
    bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9U;
    bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebU;
    return bits ^ (bits >> 31U);
}

/// Uniform noise in -1 .. 1, a function of seed and index.
[[nodiscard]] constexpr double noise_at(std::uint64_t seed, std::uint64_t index) noexcept
{
    const std::uint64_t bits = mix_bits(mix_bits(seed) ^ index);
    return static_cast<double>(bits >> 11U) * 0x1p-52 - 1.0;
}

/// Vector of noise_at(), each component uniform in -1 .. 1.
[[nodiscard]] inline Vec3 noise_vector_at(std::uint64_t seed, std::uint64_t index) noexcept
{
    return {noise_at(seed, 3 * index), noise_at(seed, 3 * index + 1),
            noise_at(seed, 3 * index + 2)};
}

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
