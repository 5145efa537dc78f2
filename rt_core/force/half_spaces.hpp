// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/math/vec3.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus
{

/// Motion of N coordinates: 3 for a point, 6 for a rigid tool, in the caller's metric.
template <int N>
using Motion = Eigen::Matrix<double, N, 1>;

/// Motions x that a plane allows: normal . x >= offset. The normal may have any length above 0.
template <int N>
struct HalfSpace
{
    Motion<N> normal{Motion<N>::Zero()};
    double offset{0.0};
};

/// Result of nearest_motion(): motion = wanted + the sum of reactions[i] x normal of held_by[i].
template <int N>
struct NearestMotion
{
    Motion<N> motion{Motion<N>::Zero()};
    /// Indices of the planes that hold the motion back, whose normals are independent.
    StaticVector<std::uint32_t, static_cast<std::size_t>(N)> held_by;
    /// Multipliers of the normals of `held_by`; not negative.
    std::array<double, static_cast<std::size_t>(N)> reactions{};
    /// False: no motion is allowed by all planes; `motion` is zero and `held_by` empty. Always true
    /// if all offsets are at most zero.
    bool is_feasible{true};
};

/// Motion nearest to `wanted` that all planes allow, to 1e-12 of the lengths in the problem. It is
/// unique, and the order of the planes changes it by rounding only.
///
/// Normals that are dependent to kParallelPlanes count as parallel: of such planes the one that
/// restrains most counts. A gap between opposite planes that is too narrow by at most
/// kSqueezeTolerance still counts as open, and one side is violated by as much.
///
/// `planes` must have at most kMaxHalfSpaces planes; these and `wanted` must be finite. Dual active
/// set method (Goldfarb and Idnani 1983): the motion is pushed out of the plane that it violates
/// most, until none is violated. Haptic thread. Cost: 0.4 to 2 us for 8 to 64 planes in three
/// dimensions, 0.7 to 5 us in six; at most kConstraintRounds steps.
template <int N>
[[nodiscard]] NearestMotion<N> nearest_motion(std::span<const HalfSpace<N>> planes,
                                              const Motion<N>& wanted) noexcept TACTUS_NONBLOCKING;

extern template NearestMotion<3> nearest_motion<3>(std::span<const HalfSpace<3>>,
                                                   const Motion<3>&) noexcept TACTUS_NONBLOCKING;
extern template NearestMotion<6> nearest_motion<6>(std::span<const HalfSpace<6>>,
                                                   const Motion<6>&) noexcept TACTUS_NONBLOCKING;

} // namespace tactus
