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

/// The velocity of a position that is known in steps of a quantum: first-order adaptive windowing
/// (Janabi-Sharifi, Hayward and Chen 2000), by the end points. Over the last n periods the velocity
/// is the straight line's from the oldest to the newest position, with the largest n whose
/// positions all lie within a quantum of their line. A slow motion gets a long window and a fine
/// answer, quantum / (n x period); a turn gets a short one at once.
///
/// Haptic thread. Cost: kVelocitySamples^2 / 2 comparisons of points at most.
class VelocityWindow
{
public:
    explicit VelocityWindow(double quantum_m) noexcept : quantum_m_(quantum_m) {}

    /// The next position, `elapsed_s` > 0 after the one before.
    void add(const Vec3& position_m, double elapsed_s) noexcept TACTUS_NONBLOCKING;
    /// Nothing is known any more.
    void clear() noexcept { count_ = 0; }

    /// Of the newest position; zero while fewer than two are known.
    [[nodiscard]] Vec3 velocity_m_per_s() const noexcept TACTUS_NONBLOCKING;

private:
    [[nodiscard]] bool is_straight(std::uint32_t last, const Vec3& velocity) const noexcept;

    double quantum_m_;
    std::array<Vec3, kVelocitySamples> positions_m_{}; ///< Newest first.
    std::array<double, kVelocitySamples> ages_s_{};    ///< Against the newest.
    std::uint32_t count_{0};
};

} // namespace tactus
