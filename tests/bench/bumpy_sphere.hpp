// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/math/vec3.hpp"
#include "tests/shared/brute_force.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

/// The surface on which forces are known: the bumpy sphere of make_shape(),
///
///     f(x) = |x| - R (1 + a sin(m u) sin(m v) sin(m w)) = 0,   (u, v, w) = x / |x|,
///
/// R = 50 mm, a = 0.02, m = 8. In metres, the sphere's centre at the origin. Everything holds
/// within 5 mm of the surface on either side; its radii of curvature are 20 mm at least.
namespace tactus::bench
{

[[nodiscard]] double bumpy_value_m(const Vec3& x);
[[nodiscard]] Vec3 bumpy_gradient(const Vec3& x);

/// The surface's nearest point.
struct SurfaceFoot
{
    Vec3 point_m{0.0, 0.0, 0.0};
    Vec3 normal{0.0, 0.0, 0.0}; ///< Outward, of length 1.
    double distance_m{0.0};     ///< Negative inside.
};
/// To rounding: x is projected onto the tangent plane of f at the last guess until nothing moves.
[[nodiscard]] SurfaceFoot bumpy_foot(const Vec3& x);

/// The larger principal curvature's amount at the foot of x, 1/m; to six digits.
[[nodiscard]] double bumpy_curvature_per_m(const Vec3& x);

/// What a ball that rests on a surface without friction does to the device that pulls it.
struct Touch
{
    double radius_m{0.0}; ///< Of the ball.
    double depth_m{0.0};  ///< Of the device below where the ball's centre rests.
    double stiffness_n_per_m{0.0};

    [[nodiscard]] double force_n() const { return stiffness_n_per_m * depth_m; }
};
/// The force on a device there: the stiffness times its depth below the surface offset by the
/// ball's radius, along the surface's normal; none above it.
[[nodiscard]] Vec3 bumpy_force_n(const Vec3& device_m, double radius_m, double stiffness_n_per_m);

/// How far a mesh is from the surface it stands for.
struct Faceting
{
    double distance_m{0.0};      ///< Largest, of points of the faces.
    double normal_rad{0.0};      ///< Largest turn of a face against the surface under it.
    double dihedral_rad{0.0};    ///< Largest turn from a face to the next one across an edge.
    double curvature_per_m{0.0}; ///< Largest of the surface.

    /// How far the force on the mesh may be from that on the surface, in newtons, when the ball
    /// rests exactly where the mesh lets it. With h and t the distance and the turn of above, k
    /// the curvature, r the ball's radius and d the depth:
    ///
    /// The places where the ball has room end between the surface's offsets by r - h and r + h, so
    /// the spring's length is d within h. Each face it touches pushes along a direction within t
    /// of the surface's normal at the touched point; that normal turns by k for each metre along
    /// the surface. The touched points are within r t / (1 - k r) of the foot of the ball, the
    /// foot within d p / (1 - k r) of the device's, where p is the force's turn: together
    /// p <= t / (1 - k (r + d)), to first order in t, and the force is off by at most
    /// stiffness x (h + d p).
    [[nodiscard]] double force_error_n(const Touch& touch) const;
    /// p.
    [[nodiscard]] double force_turn_rad(const Touch& touch) const;
};
/// Measures all faces at their corners, the middles of their edges and their centres; in the mesh's
/// own frame, whose origin lies at `origin_m` of the surface's. Some 3 us a face.
[[nodiscard]] Faceting measure_faceting(const std::vector<test::Face>& faces,
                                        const std::array<double, 3>& origin_m);

/// The largest angle between the normals of two faces that share an edge; edges are the same when
/// both ends are, bit for bit.
[[nodiscard]] double largest_dihedral_rad(const std::vector<test::Face>& faces);

/// A device's way along a great circle of the surface, held at a depth below where the ball rests.
struct Sweep
{
    std::vector<Vec3> goals_m; ///< Of the device.
    std::vector<Vec3> rests_m; ///< Of the ball's centre, were the mesh the surface.
    std::size_t lead_in{0};    ///< Frames at the start that come down on the surface.
};
/// After the lead-in a frame for each of `steps_m`, so far in the device's straight distance, round
/// and round a circle that lies askew to the icosahedron and to the bumps.
[[nodiscard]] Sweep make_sweep(const Touch& touch, std::span<const double> steps_m);
/// `frames` equal steps.
[[nodiscard]] Sweep make_sweep(const Touch& touch, double step_m, std::uint32_t frames);

} // namespace tactus::bench
