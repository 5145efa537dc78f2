// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/force/half_spaces.hpp"
#include "rt_core/force/placed_surface.hpp"
#include "rt_core/kernels/kernels.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/infinity.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>

namespace tactus
{

/// The triangles that a sphere near one place can touch, each with a separating plane.
///
/// A triangle is convex, so all of it lies behind the plane through its point nearest to the
/// sphere's centre, perpendicular to the line between the two: motions that a plane allows, of any
/// length, are free of the triangle. Planes are computed at the sphere's present place for the
/// triangles that a motion would enter; the others keep those from farther away, which only
/// restrict more.
///
/// It is a view of the surfaces: batches of eight triangles as the queries found them. Single
/// precision proposes planes and proves that a motion is free (PlaneTable); double precision
/// decides the rest.
///
/// Checks are counted against an allowance (Budgets::planes). Once it is used up the search for
/// entered faces ends, and only motions proven by single precision are free.
///
/// Lengths in metres, in the world; places relative to the centre. Haptic thread. 38 KiB.
class Vicinity
{
public:
    static constexpr std::uint32_t kUnlimited = 0xFFFF'FFFFU;

    /// Lists the triangles of the surfaces, which were queried at `center_m` and outlive it; all
    /// others are at least `reach_m` from there. If more are in reach than fit, reach_m() is less.
    /// `planes` is the allowance of checks. Costs 2 ns a triangle.
    Vicinity(std::span<const PlacedSurface> surfaces, Vec3 center_m, double reach_m,
             std::uint32_t planes = kUnlimited) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] const Vec3& center_m() const noexcept { return center_m_; }
    /// Distance from the centre of every triangle that isn't listed, at least.
    [[nodiscard]] double reach_m() const noexcept { return reach_m_; }
    /// Upper end of the faces' numbers; not every number is a face.
    [[nodiscard]] std::uint32_t size() const noexcept { return kPlaneLanes * batches_; }
    [[nodiscard]] bool has(std::uint32_t face) const noexcept;
    /// Index of the surface that a face belongs to.
    [[nodiscard]] std::uint32_t surface_of(std::uint32_t face) const noexcept
    {
        return surface_[face / kPlaneLanes];
    }
    /// Counts checks that were done elsewhere among its planes.
    void use(std::uint32_t planes) noexcept { planes_left_ -= std::min(planes, planes_left_); }
    [[nodiscard]] std::uint32_t planes_left() const noexcept { return planes_left_; }
    [[nodiscard]] bool is_spent() const noexcept { return planes_left_ == 0; }
    /// Lower bound on the distance from `place` to any face of a surface; infinite if none is
    /// listed.
    [[nodiscard]] double bound_of_surface(std::uint32_t surface,
                                          const Vec3& place) const noexcept TACTUS_NONBLOCKING;

    /// Moves the sphere's centre to `place`. A place on a face takes `fallback` (unit length) as
    /// its direction.
    void stand_at(const Vec3& place, const Vec3& fallback) noexcept TACTUS_NONBLOCKING;
    /// Lists faces within this distance of here, in order, as many as fit in `faces`. It checks up
    /// to kMaxTouchLooks faces even with a spent allowance. From then on find_entered() knows the
    /// sphere's depth in the faces here.
    struct Listed
    {
        std::size_t count{0};
        bool is_all{true};
    };
    [[nodiscard]] Listed list_within(double distance_m,
                                     std::span<std::uint32_t> faces) noexcept TACTUS_NONBLOCKING;
    /// Motions from here that keep a sphere of this radius on its side of the face; checks the face
    /// first. 40 ns.
    [[nodiscard]] HalfSpace<3> half_space(std::uint32_t face,
                                          double radius_m) noexcept TACTUS_NONBLOCKING;
    /// The face that a sphere of this radius enters deepest on this motion from here; none if the
    /// motion is free, or the allowance is used up. Faces in `passed` are skipped. About 10 ns for
    /// each near batch, and 40 ns for each face that single precision can't decide.
    [[nodiscard]] std::optional<std::uint32_t>
    find_entered(const Vec3& motion, double radius_m,
                 std::span<const std::uint32_t> passed = {}) noexcept TACTUS_NONBLOCKING;
    /// Share of the motion, 0 .. 1, that is free by the planes seen from here. It checks all
    /// batches even with a spent allowance.
    [[nodiscard]] double free_share(const Vec3& motion,
                                    double radius_m) noexcept TACTUS_NONBLOCKING;
    /// Share of the motion, 0 .. 1, before a sphere of this radius touches the face: a lower bound,
    /// usually by kLeastStep radii at most.
    [[nodiscard]] double share_before(std::uint32_t face, const Vec3& motion,
                                      double radius_m) noexcept TACTUS_NONBLOCKING;

private:
    static constexpr std::uint32_t kLooks = 32;

    /// Batches of a surface, in quanta of its model around the centre.
    struct Part
    {
        PlaneTable table{};
        std::uint32_t first{0};         ///< First of its batches.
        double unit_m{1.0};             ///< Size of a quantum in the world.
        Vec3 last_place{0.0, 0.0, 0.0}; ///< Place of the last question.
        std::array<float, 3> stand{};
    };
    struct Plane // NOLINT(cppcoreguidelines-pro-type-member-init): many, set where they are seen.
    {
        Vec3 normal;     ///< Unit vector from the face to the sphere.
        double offset_m; ///< Height of the centre above the plane.

        [[nodiscard]] double height_m(const Vec3& place) const noexcept
        {
            return normal.dot(place) + offset_m;
        }
    };
    struct Look
    {
        std::uint32_t face{0};
        std::uint32_t stand{0}; ///< 0: never checked.
    };
    using Hits = std::span<PlaneHit>;

    void add(const PlacedSurface& placed, double farthest_m) noexcept;
    void add_batch(const PlacedSurface& placed, std::uint32_t batch, PlaneTable& table) noexcept;
    [[nodiscard]] const ObjectPose& pose_of(const Part& part) const noexcept;
    [[nodiscard]] std::array<float, 3> in_quanta(const Part& part,
                                                 const Vec3& place) const noexcept;
    [[nodiscard]] PlaneQuestion question(const Part& part, const Vec3& place) const noexcept;
    [[nodiscard]] Hits find_below(Part& part, const Vec3& place,
                                  double least_m) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] const LocalTriangle& triangle(std::uint32_t face) const noexcept;
    [[nodiscard]] Plane see(std::uint32_t face, const Vec3& place) const noexcept;
    [[nodiscard]] bool is_seen(std::uint32_t face) const noexcept;
    [[nodiscard]] const Plane& look_at(std::uint32_t face) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] double least_here_m(double radius_m) const noexcept;
    [[nodiscard]] double proven_share(std::uint32_t face, const Vec3& here, const Vec3& way,
                                      double radius_m) const noexcept;

    std::span<const PlacedSurface> surfaces_;
    Vec3 center_m_;
    double reach_m_;
    Vec3 place_{0.0, 0.0, 0.0};
    Vec3 fallback_{0.0, 0.0, 1.0};
    std::uint32_t stand_{1};
    /// Lower bound on the distance of faces from the present place, by list_within().
    double clear_m_{kInfinity};
    std::uint32_t planes_left_;
    std::uint32_t batches_{0};
    StaticVector<Part, kMaxNear> parts_; ///< Same order as the surfaces.
    std::array<PlaneRows, kMaxNearBatches> planes_;
    std::array<PlaneSeen, kMaxNearBatches> seen_;
    alignas(32) std::array<float, kMaxNearBatches + kPlaneLanes * kMaxNear> lows_;
    std::array<const void*, kMaxNearBatches> triangles_;
    std::array<std::uint8_t, kMaxNearBatches> surface_;
    std::array<std::uint8_t, kMaxNearBatches> faces_; ///< Number of a batch's lanes in use.
    std::array<PlaneHit, kMaxNearBatches> hits_;
    std::array<Look, kLooks> looks_{};      ///< Checks in double from here.
    std::array<Plane, kLooks> look_planes_; ///< Planes of these checks.
};

} // namespace tactus
