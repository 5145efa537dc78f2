// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/force/placed_surface.hpp"
#include "rt_core/math/vec3.hpp"

#include <cstdint>
#include <span>

namespace tactus
{

/// Normals that go over from facet to facet, as energy of the spring between hand and proxy.
///
/// A ball that touches a coarse mesh feels a step wherever it goes over an edge. The planes of the
/// faces round it, each weighted by how near its face is, have a mean height that does not step:
///
///     h(p) = sum of w_j (radius - height of p over plane j) / (sum of w_j + a little)
///
/// It is below width / 8 whatever the mesh, as faces whose planes pass farther from the ball have
/// no weight; faces that are turned by more than 25 degrees have none either, so sharp edges stay.
/// As with a texture the spring holds K e(d) h(p) beside K d^2 / 2, d being the depth:
///
///     e(d) = d^2 / (d + D), D = width / 16
///
/// So the proxy rests where the planes hold a hand that is raised by e along the mean normal. Of a
/// step at an edge the share D / (d + D) is left. Proofs: docs/stability.md.
///
/// Any thread: functions of their arguments alone; no call waits or allocates.
class SmoothNormals
{
public:
    /// What is asked: a ball that touches, world frame.
    struct Place
    {
        Vec3 center_m{0.0, 0.0, 0.0};
        Vec3 normal{0.0, 0.0, 1.0}; ///< Of what it touches; unit length.
        double radius_m{0.0};
        double moved_m{0.0}; ///< From where the surfaces were queried.
    };
    /// What the hand's spring has of it, where the hand is `depth_m` behind what the ball touches.
    struct Felt
    {
        Vec3 raise_m{0.0, 0.0, 0.0}; ///< Of the hand, for the proxy; e(d) along the normal.
        double raised_m{0.0};        ///< e(d)
        double push_m{0.0};          ///< e'(d) h: times K, what is pushed more along the normal.
        double stiffening{1.0};      ///< How much stiffer than K it gets there, at most.
        std::uint32_t looks{0};      ///< Faces that were looked at, 300 instructions each.
    };

    SmoothNormals() noexcept = default;
    /// Of a width > 0, in the world. `surfaces` were queried where the ball is now and outlive it;
    /// from everything else it is at least `clear_m` away. Goes through their distances.
    SmoothNormals(double width_m, std::span<const PlacedSurface> surfaces,
                  double clear_m) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] bool are_on() const noexcept { return width_m_ > 0.0; }
    /// How far beyond a ball's radius surfaces are needed for it.
    [[nodiscard]] static double reach_beyond_m(double radius_m,
                                               double width_m) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] Felt at(const Place& place, double depth_m) const noexcept TACTUS_NONBLOCKING;

private:
    /// Of one object, whose frame the vectors are in.
    struct Sums
    {
        double weight{0.0};
        double rise_m{0.0};               ///< Weight x rise, as of each line below.
        Vec3 normal{0.0, 0.0, 0.0};       ///< Weight x normal.
        Vec3 weight_slope{0.0, 0.0, 0.0}; ///< The derivative of the weight.
        Vec3 sloping_rise{0.0, 0.0, 0.0}; ///< The derivative of the weight, x rise.
        std::uint32_t looks{0};
    };

    void add(const PlacedSurface& placed, const Place& place, double reach_m,
             Sums& sums) const noexcept;

    double width_m_{0.0};
    double known_m_{0.0}; ///< All that is this near to where it was queried is looked at.
    std::span<const PlacedSurface> surfaces_;
};

} // namespace tactus
