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
/// The height is below width / 8 for any mesh, as faces with planes farther from the sphere have no
/// weight. Faces rotated by more than 25 degrees have none either, so sharp edges stay. Besides K
/// d^2 / 2 with the depth d, the spring holds K e(d) h(p), as with a texture:
///
///     e(d) = d^2 / (d + D), D = width / 16
///
/// So the proxy rests where the planes hold a goal that is raised by e along the mean normal. The
/// share D / (d + D) of a step at an edge remains. Proofs: docs/internals/passivity.md.
///
/// Usable on any thread: pure functions, none of which waits or allocates.
class ForceShading
{
public:
    /// Place of a sphere that touches, in the world.
    struct Place
    {
        Vec3 center_m{0.0, 0.0, 0.0};
        Vec3 normal{0.0, 0.0, 1.0}; ///< Normal of the sphere's contact; unit length.
        double radius_m{0.0};
        /// Distance of the sphere from the place where the surfaces were queried.
        double moved_m{0.0};
    };
    /// Effect of the shading on the device's spring, with the goal `depth_m` behind the contact.
    struct Felt
    {
        /// Offset of the goal that the proxy follows: e(d) along the mean normal.
        Vec3 raise_m{0.0, 0.0, 0.0};
        double raised_m{0.0};   ///< Length e(d) of the raise along the contact's normal.
        double push_m{0.0};     ///< Product e'(d) h: times K, the added push along the normal.
        double stiffening{1.0}; ///< Bound on the spring's stiffness there, as a multiple of K.
        std::uint32_t looks{0}; ///< Number of faces checked, 300 instructions each.
    };

    ForceShading() noexcept = default;
    /// Shading over a width > 0, in metres of the world. `surfaces` must have been queried at the
    /// sphere's present place and must outlive this object; other surfaces are at least `clear_m`
    /// away. Visits all distances of the surfaces.
    ForceShading(double width_m, std::span<const PlacedSurface> surfaces,
                 double clear_m) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] bool are_on() const noexcept { return width_m_ > 0.0; }
    /// Distance beyond a sphere's radius within which surfaces are needed.
    [[nodiscard]] static double reach_beyond_m(double radius_m,
                                               double width_m) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] Felt at(const Place& place, double depth_m) const noexcept TACTUS_NONBLOCKING;

private:
    /// Weighted sums over the faces of one object, in the object's frame.
    struct Sums
    {
        double weight{0.0};
        double rise_m{0.0};         ///< Sum of weight x rise of the sphere into the face's plane.
        Vec3 normal{0.0, 0.0, 0.0}; ///< Sum of weight x normal.
        /// Sum of the weights' derivatives by the sphere's place.
        Vec3 weight_slope{0.0, 0.0, 0.0};
        Vec3 sloping_rise{0.0, 0.0, 0.0}; ///< Sum of the weights' derivatives x rise.
        std::uint32_t looks{0};
    };

    void add(const PlacedSurface& placed, const Place& place, double reach_m,
             Sums& sums) const noexcept;

    double width_m_{0.0};
    /// Distance from the query's place within which all faces are known.
    double known_m_{0.0};
    std::span<const PlacedSurface> surfaces_;
};

} // namespace tactus
