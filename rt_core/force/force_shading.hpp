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

/// Force shading: normals that blend from facet to facet, as energy of the spring between device
/// and proxy.
///
/// A sphere that touches a coarse mesh feels a step at each edge that it crosses. The planes of the
/// faces round it, each weighted by the nearness of its face, have a mean height without steps:
///
///     h(p) = sum of w_j (radius - height of p over plane j) / (sum of w_j + a little)
///
/// It is below width / 8 for any mesh, as faces whose planes pass farther from the sphere have no
/// weight; faces that are rotated by more than 25 degrees have none either, so sharp edges stay. As
/// with a texture the spring holds K e(d) h(p) besides K d^2 / 2, d being the depth:
///
///     e(d) = d^2 / (d + D), D = width / 16
///
/// So the proxy rests where the planes hold a goal that is raised by e along the mean normal. The
/// share D / (d + D) of a step at an edge remains. Proofs: docs/stability.md.
///
/// Any thread: the functions depend on their arguments alone; no call waits or allocates.
class ForceShading
{
public:
    /// Query: a sphere that touches, world frame.
    struct Place
    {
        Vec3 center_m{0.0, 0.0, 0.0};
        Vec3 normal{0.0, 0.0, 1.0}; ///< Normal of its contact; unit length.
        double radius_m{0.0};
        double moved_m{0.0}; ///< Distance from the place of the surfaces' query.
    };
    /// Effect on the device's spring, with the goal `depth_m` behind the contact.
    struct Felt
    {
        Vec3 raise_m{0.0, 0.0, 0.0}; ///< Offset of the goal, for the proxy: e(d) along the normal.
        double raised_m{0.0};        ///< e(d)
        double push_m{0.0};          ///< e'(d) h: times K, the added push along the normal.
        double stiffening{1.0};      ///< Bound on the stiffness there, in K.
        std::uint32_t looks{0};      ///< Faces checked, 300 instructions each.
    };

    ForceShading() noexcept = default;
    /// Normals over a width > 0, in the world. `surfaces` were queried at the sphere's present
    /// place and outlive this object; all others are at least `clear_m` away. Visits all distances
    /// of the surfaces.
    ForceShading(double width_m, std::span<const PlacedSurface> surfaces,
                 double clear_m) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] bool are_on() const noexcept { return width_m_ > 0.0; }
    /// Distance beyond a sphere's radius within which surfaces are needed.
    [[nodiscard]] static double reach_beyond_m(double radius_m,
                                               double width_m) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] Felt at(const Place& place, double depth_m) const noexcept TACTUS_NONBLOCKING;

private:
    /// Sums over one object's faces, in its frame.
    struct Sums
    {
        double weight{0.0};
        double rise_m{0.0};               ///< Weight x rise.
        Vec3 normal{0.0, 0.0, 0.0};       ///< Weight x normal.
        Vec3 weight_slope{0.0, 0.0, 0.0}; ///< Derivative of the weight.
        Vec3 sloping_rise{0.0, 0.0, 0.0}; ///< Derivative of the weight, x rise.
        std::uint32_t looks{0};
    };

    void add(const PlacedSurface& placed, const Place& place, double reach_m,
             Sums& sums) const noexcept;

    double width_m_{0.0};
    /// All faces within this distance of the query's place are known.
    double known_m_{0.0};
    std::span<const PlacedSurface> surfaces_;
};

} // namespace tactus
