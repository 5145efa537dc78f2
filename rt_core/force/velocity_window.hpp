// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/vec3.hpp"

#include <array>
#include <cstdint>

namespace tactus
{

/// Velocity of a position that is known in steps of a quantum: first-order adaptive windowing
/// (Janabi-Sharifi, Hayward and Chen 2000). The velocity is that of the straight line from the
/// oldest to the newest position of a window. The window is the longest whose positions all lie
/// within a quantum of their line. A slow motion gets a long window of n periods and a resolution
/// of quantum / (n x period); a reversal gets a short one at once.
///
/// Haptic thread. Cost: kVelocitySamples^2 / 2 comparisons of points at most.
class VelocityWindow
{
public:
    explicit VelocityWindow(double quantum_m) noexcept : quantum_m_(quantum_m) {}

    /// Adds a position that was measured `elapsed_s` > 0 after the last one.
    void add(const Vec3& position_m, double elapsed_s) noexcept TACTUS_NONBLOCKING;
    /// Drops all positions.
    void clear() noexcept { count_ = 0; }

    /// Velocity of the newest position; zero with fewer than two positions.
    [[nodiscard]] Vec3 velocity_m_per_s() const noexcept TACTUS_NONBLOCKING;

private:
    [[nodiscard]] bool is_straight(std::uint32_t last, const Vec3& velocity) const noexcept;

    double quantum_m_;
    std::array<Vec3, kVelocitySamples> positions_m_{}; ///< Positions, newest first.
    /// Age of each position relative to the newest.
    std::array<double, kVelocitySamples> ages_s_{};
    std::uint32_t count_{0};
};

} // namespace tactus
