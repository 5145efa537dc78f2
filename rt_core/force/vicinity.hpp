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

/// Triangles that a sphere near one place can touch, each with a separating plane.
///
/// A triangle lies behind the plane through its point nearest to the sphere's centre, perpendicular
/// to the line between the two. Motions that a plane allows, of any length, are free of its
/// triangle. Planes are computed at the sphere's present place for triangles that a motion would
/// enter. Other triangles keep planes from an earlier place, which only restrict more.
///
/// The list is a view of the surfaces, in batches of eight triangles as the queries found them.
/// Single precision proposes planes and proves motions free (PlaneTable); double precision decides
/// the rest.
///
/// Checks are taken from an allowance (Budgets::planes). Once it is used up, the search for entered
/// faces ends, and only motions that single precision proves are free.
///
/// Lengths are in metres of the world; places are relative to center_m(). Haptic thread. 38 KiB.
class Vicinity
{
public:
    static constexpr std::uint32_t kUnlimited = 0xFFFF'FFFFU;

    /// Lists the triangles of `surfaces`, which were queried at `center_m` and must outlive this
    /// object; all other triangles are at least `reach_m` away. If more triangles are in reach than
    /// fit, reach_m() is smaller. `planes` is the allowance of checks. Costs 2 ns a triangle.
    Vicinity(std::span<const PlacedSurface> surfaces, Vec3 center_m, double reach_m,
             std::uint32_t planes = kUnlimited) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] const Vec3& center_m() const noexcept { return center_m_; }
    /// Lower bound on the distance of unlisted triangles from center_m().
    [[nodiscard]] double reach_m() const noexcept { return reach_m_; }
    /// End of the range of face numbers; not every number in it is a face.
    [[nodiscard]] std::uint32_t size() const noexcept { return kPlaneLanes * batches_; }
    [[nodiscard]] bool has(std::uint32_t face) const noexcept;
    /// Index of the surface that a face belongs to.
    [[nodiscard]] std::uint32_t surface_of(std::uint32_t face) const noexcept
    {
        return surface_[face / kPlaneLanes];
    }
    /// Takes checks done elsewhere from the allowance.
    void use(std::uint32_t planes) noexcept { planes_left_ -= std::min(planes, planes_left_); }
    [[nodiscard]] std::uint32_t planes_left() const noexcept { return planes_left_; }
    [[nodiscard]] bool is_spent() const noexcept { return planes_left_ == 0; }
    /// Lower bound on the distance from `place` to the listed faces of a surface; infinite without
    /// any.
    [[nodiscard]] double bound_of_surface(std::uint32_t surface,
                                          const Vec3& place) const noexcept TACTUS_NONBLOCKING;

    /// Moves the sphere to `place`. If it is on a face, `fallback` (unit length) is the direction
    /// from the face.
    void stand_at(const Vec3& place, const Vec3& fallback) noexcept TACTUS_NONBLOCKING;
    /// Lists faces within `distance_m` of the sphere's place, in order, as many as fit in `faces`.
    /// Checks up to kMaxTouchLooks faces, even with a spent allowance. Later calls of
    /// find_entered() then use the sphere's depth in these faces.
    struct Listed
    {
        std::size_t count{0};
        bool is_all{true};
    };
    [[nodiscard]] Listed list_within(double distance_m,
                                     std::span<std::uint32_t> faces) noexcept TACTUS_NONBLOCKING;
    /// Returns the motions from the sphere's place that keep a sphere of this radius on its side of
    /// the face. 40 ns if the face was not checked yet.
    [[nodiscard]] HalfSpace<3> half_space(std::uint32_t face,
                                          double radius_m) noexcept TACTUS_NONBLOCKING;
    /// Finds the face that a sphere of this radius enters deepest on a motion from its place, other
    /// than those in `passed`. None if the motion is free, or the allowance is used up. About 10 ns
    /// for each near batch, and 40 ns for each face that single precision can't decide.
    [[nodiscard]] std::optional<std::uint32_t>
    find_entered(const Vec3& motion, double radius_m,
                 std::span<const std::uint32_t> passed = {}) noexcept TACTUS_NONBLOCKING;
    /// Share of the motion, 0 .. 1, that the planes at the sphere's place allow. Checks all batches
    /// even with a spent allowance.
    [[nodiscard]] double free_share(const Vec3& motion,
                                    double radius_m) noexcept TACTUS_NONBLOCKING;
    /// Share of the motion, 0 .. 1, before a sphere of this radius touches the face: a lower bound,
    /// usually within kLeastStep radii of the true share.
    [[nodiscard]] double share_before(std::uint32_t face, const Vec3& motion,
                                      double radius_m) noexcept TACTUS_NONBLOCKING;

private:
    static constexpr std::uint32_t kLooks = 32;

    /// Batches of one surface, in quanta of its model relative to center_m().
    struct Part
    {
        PlaneTable table{};
        std::uint32_t first{0};         ///< Index of the surface's first batch.
        double unit_m{1.0};             ///< Size of a quantum in metres of the world.
        Vec3 last_place{0.0, 0.0, 0.0}; ///< Place at which the planes were last tested.
        std::array<float, 3> stand{};
    };
    struct Plane // NOLINT(cppcoreguidelines-pro-type-member-init): many, set where they are seen.
    {
        Vec3 normal;     ///< Unit vector from the face to the sphere.
        double offset_m; ///< Height of center_m() above the plane.

        [[nodiscard]] double height_m(const Vec3& place) const noexcept
        {
            return normal.dot(place) + offset_m;
        }
    };
    struct Look
    {
        std::uint32_t face{0};
        std::uint32_t stand{0}; ///< Value of stand_ when the face was checked; 0: never.
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
    /// Lower bound on the distance of faces from the sphere's place, as found by list_within().
    double clear_m_{kInfinity};
    std::uint32_t planes_left_;
    std::uint32_t batches_{0};
    StaticVector<Part, kMaxNear> parts_; ///< Batches of each surface, in the order of surfaces_.
    std::array<PlaneRows, kMaxNearBatches> planes_;
    std::array<PlaneSeen, kMaxNearBatches> seen_;
    alignas(32) std::array<float, kMaxNearBatches + kPlaneLanes * kMaxNear> lows_;
    std::array<const void*, kMaxNearBatches> triangles_;
    std::array<std::uint8_t, kMaxNearBatches> surface_;
    std::array<std::uint8_t, kMaxNearBatches> faces_; ///< Number of lanes in use in each batch.
    std::array<PlaneHit, kMaxNearBatches> hits_;
    std::array<Look, kLooks> looks_{};      ///< Checks in double precision from the present place.
    std::array<Plane, kLooks> look_planes_; ///< Planes found by the checks in looks_.
};

} // namespace tactus
