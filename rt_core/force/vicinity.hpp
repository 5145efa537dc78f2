// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/force/half_spaces.hpp"
#include "rt_core/force/placed_surface.hpp"
#include "rt_core/limits.hpp"

#include <cstdint>
#include <optional>
#include <span>

namespace tactus
{

/// The triangles that a ball near one place can touch, each with a plane between the two.
///
/// A triangle is convex, so all of it lies behind the plane through its point nearest to the ball's
/// centre, square to the line between the two: where a plane lets the ball go, however far, the
/// triangle does too. Planes are found from where the ball stands, for the triangles that a motion
/// would enter; the others keep what was seen from farther away, which only takes away more.
///
/// Lengths in metres, in the world; places relative to the centre. Haptic thread.
class Vicinity
{
public:
    /// The triangles within `reach_m` of `center_m`. Where more are in reach than fit, reach_m() is
    /// less than asked for. `anchor_m` is where the surfaces were queried. The surfaces outlive it.
    /// Costs 1 ns for a triangle that is out of reach.
    Vicinity(std::span<const PlacedSurface> surfaces, const Vec3& anchor_m, const Vec3& center_m,
             double reach_m) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] const Vec3& center_m() const noexcept { return center_m_; }
    /// Every triangle that isn't in the list is at least this far from the centre.
    [[nodiscard]] double reach_m() const noexcept { return reach_m_; }
    [[nodiscard]] std::uint32_t size() const noexcept
    {
        return static_cast<std::uint32_t>(faces_.size());
    }
    /// Which of the surfaces a face belongs to.
    [[nodiscard]] std::uint32_t surface_of(std::uint32_t face) const noexcept
    {
        return faces_[face].surface;
    }
    /// No more than the distance from `place` to the face.
    [[nodiscard]] double bound(std::uint32_t face, const Vec3& place) const noexcept;
    /// The same for all faces of a surface; infinite when none is listed.
    [[nodiscard]] double bound_of_surface(std::uint32_t surface,
                                          const Vec3& place) const noexcept TACTUS_NONBLOCKING;

    /// The ball's centre is at `place` now. A place on a face sees it along `fallback` (unit
    /// length).
    void stand_at(const Vec3& place, const Vec3& fallback) noexcept TACTUS_NONBLOCKING;
    /// Whether a face is within this distance of here; looks at it if it may be.
    [[nodiscard]] bool is_within(std::uint32_t face, double distance_m) noexcept TACTUS_NONBLOCKING;
    /// The motions from here that keep a ball of this radius on its side of the face; looks at the
    /// face first. 60 ns.
    [[nodiscard]] HalfSpace<3> half_space(std::uint32_t face,
                                          double radius_m) noexcept TACTUS_NONBLOCKING;
    /// Of the faces that a ball of this radius, seen from here, enters on this motion, the one
    /// that it enters deepest; none when the way is free. 2 ns a face, and 60 ns for each that has
    /// to be looked at.
    [[nodiscard]] std::optional<std::uint32_t>
    find_entered(const Vec3& motion, double radius_m) noexcept TACTUS_NONBLOCKING;
    /// Whether a ball of this radius meets nothing on a straight way. Stands half-way to see.
    [[nodiscard]] bool is_free(const Vec3& from, const Vec3& to,
                               double radius_m) noexcept TACTUS_NONBLOCKING;
    /// How much of the motion, 0 .. 1, is free as far as the planes say that are known.
    [[nodiscard]] double free_share(const Vec3& motion,
                                    double radius_m) const noexcept TACTUS_NONBLOCKING;

private:
    struct NearFace
    {
        const LocalTriangle* triangle{nullptr};
        std::uint32_t surface{0};
        std::uint32_t stand{0};     ///< From which the plane was found; 0: there is none yet.
        Vec3 normal{0.0, 0.0, 0.0}; ///< From the face to the ball; unit length.
        /// Of the centre from the plane; without a plane from the face, at least.
        double offset_m{0.0};
    };

    [[nodiscard]] bool try_gather(double moved_m) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] static double bound(const NearFace& face, const Vec3& place) noexcept;
    void look_at(NearFace& face) const noexcept TACTUS_NONBLOCKING;

    std::span<const PlacedSurface> surfaces_;
    Vec3 center_m_;
    double reach_m_;
    Vec3 place_{0.0, 0.0, 0.0};
    Vec3 fallback_{0.0, 0.0, 1.0};
    std::uint32_t stand_{1};
    StaticVector<NearFace, kMaxNearFaces> faces_;
};

inline double Vicinity::bound(const NearFace& face, const Vec3& place) noexcept
{
    return face.stand > 0 ? face.normal.dot(place) + face.offset_m : face.offset_m - place.norm();
}

inline double Vicinity::bound(std::uint32_t face, const Vec3& place) const noexcept
{
    return bound(faces_[face], place);
}

} // namespace tactus
