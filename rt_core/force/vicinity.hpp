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

/// The triangles that a ball near one place can touch, each with a plane between the two.
///
/// A triangle is convex, so all of it lies behind the plane through its point nearest to the ball's
/// centre, square to the line between the two: where a plane lets the ball go, however far, the
/// triangle does too. Planes are found from where the ball stands, for the triangles that a motion
/// would enter; the others keep what was seen from farther away, which only takes away more.
///
/// It is a view of the surfaces: batches of eight triangles as the queries found them. Single
/// precision proposes planes and proves that a motion is free (PlaneTable); of what it can't prove
/// double decides.
///
/// What is looked at is counted against an allowance (Budgets::planes). When that is used up the
/// search for what a motion enters ends, and only what single precision proves is free.
///
/// Lengths in metres, in the world; places relative to the centre. Haptic thread. 38 KiB.
class Vicinity
{
public:
    static constexpr std::uint32_t kUnlimited = 0xFFFF'FFFFU;

    /// The triangles of the surfaces, which were queried at `center_m` and outlive it; what isn't
    /// among them is at least `reach_m` from there. Where more are in reach than fit, reach_m() is
    /// less. `planes` is what it may look at. Costs 2 ns a triangle.
    Vicinity(std::span<const PlacedSurface> surfaces, Vec3 center_m, double reach_m,
             std::uint32_t planes = kUnlimited) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] const Vec3& center_m() const noexcept { return center_m_; }
    /// Every triangle that isn't in the list is at least this far from the centre.
    [[nodiscard]] double reach_m() const noexcept { return reach_m_; }
    /// Faces are below this; not every number is one.
    [[nodiscard]] std::uint32_t size() const noexcept { return kPlaneLanes * batches_; }
    [[nodiscard]] bool has(std::uint32_t face) const noexcept;
    /// Which of the surfaces a face belongs to.
    [[nodiscard]] std::uint32_t surface_of(std::uint32_t face) const noexcept
    {
        return surface_[face / kPlaneLanes];
    }
    /// Counts work that somebody else did among its planes.
    void use(std::uint32_t planes) noexcept { planes_left_ -= std::min(planes, planes_left_); }
    [[nodiscard]] std::uint32_t planes_left() const noexcept { return planes_left_; }
    [[nodiscard]] bool is_spent() const noexcept { return planes_left_ == 0; }
    /// No more than the distance from `place` to any face of a surface; infinite when none is
    /// listed.
    [[nodiscard]] double bound_of_surface(std::uint32_t surface,
                                          const Vec3& place) const noexcept TACTUS_NONBLOCKING;

    /// The ball's centre is at `place` now. A place on a face sees it along `fallback` (unit
    /// length).
    void stand_at(const Vec3& place, const Vec3& fallback) noexcept TACTUS_NONBLOCKING;
    /// Faces within this distance of here, in order; what has no room in `faces` is left out.
    /// Whatever was looked at before, kMaxTouchLooks faces are. From now on find_entered() knows
    /// how deep the ball is in faces here.
    struct Listed
    {
        std::size_t count{0};
        bool is_all{true};
    };
    [[nodiscard]] Listed list_within(double distance_m,
                                     std::span<std::uint32_t> faces) noexcept TACTUS_NONBLOCKING;
    /// The motions from here that keep a ball of this radius on its side of the face; looks at the
    /// face first. 40 ns.
    [[nodiscard]] HalfSpace<3> half_space(std::uint32_t face,
                                          double radius_m) noexcept TACTUS_NONBLOCKING;
    /// Of the faces that a ball of this radius, seen from here, enters on this motion, the one
    /// that it enters deepest; none when the way is free, or the allowance is used up. `passed` are
    /// not looked at. Some 10 ns for each batch that is near, and 40 ns for each face that single
    /// precision can't tell.
    [[nodiscard]] std::optional<std::uint32_t>
    find_entered(const Vec3& motion, double radius_m,
                 std::span<const std::uint32_t> passed = {}) noexcept TACTUS_NONBLOCKING;
    /// How much of the motion, 0 .. 1, is free as far as the planes seen from here say. Whatever
    /// was looked at before, no batch is passed over.
    [[nodiscard]] double free_share(const Vec3& motion,
                                    double radius_m) noexcept TACTUS_NONBLOCKING;
    /// How much of the motion, 0 .. 1, a ball of this radius can go before it touches the face: no
    /// more than that, and as a rule less by kLeastStep radii at most.
    [[nodiscard]] double share_before(std::uint32_t face, const Vec3& motion,
                                      double radius_m) noexcept TACTUS_NONBLOCKING;

private:
    static constexpr std::uint32_t kLooks = 32;

    /// A surface's batches, in quanta of its model around the centre.
    struct Part
    {
        PlaneTable table{};
        std::uint32_t first{0};         ///< Of its batches.
        double unit_m{1.0};             ///< A quantum, in the world.
        Vec3 last_place{0.0, 0.0, 0.0}; ///< That was asked about.
        std::array<float, 3> stand{};
    };
    struct Plane // NOLINT(cppcoreguidelines-pro-type-member-init): many, set where they are seen.
    {
        Vec3 normal;     ///< From the face to the ball; unit length.
        double offset_m; ///< Of the centre from the plane.

        [[nodiscard]] double height_m(const Vec3& place) const noexcept
        {
            return normal.dot(place) + offset_m;
        }
    };
    struct Look
    {
        std::uint32_t face{0};
        std::uint32_t stand{0}; ///< 0: at nothing yet.
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
    double clear_m_{kInfinity}; ///< No face is nearer to the stand, as far as list_within() knows.
    std::uint32_t planes_left_;
    std::uint32_t batches_{0};
    StaticVector<Part, kMaxNear> parts_; ///< Of the surfaces, in their order.
    std::array<PlaneRows, kMaxNearBatches> planes_;
    std::array<PlaneSeen, kMaxNearBatches> seen_;
    alignas(32) std::array<float, kMaxNearBatches + kPlaneLanes * kMaxNear> lows_;
    std::array<const void*, kMaxNearBatches> triangles_;
    std::array<std::uint8_t, kMaxNearBatches> surface_;
    std::array<std::uint8_t, kMaxNearBatches> faces_; ///< How many of a batch's lanes have one.
    std::array<PlaneHit, kMaxNearBatches> hits_;
    std::array<Look, kLooks> looks_{};      ///< In double, from here:
    std::array<Plane, kLooks> look_planes_; ///< what was seen there.
};

} // namespace tactus
