// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/vicinity.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/math/rounding.hpp"
#include "rt_core/query/probe.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <utility>

namespace tactus
{

namespace
{

static_assert(sizeof(LocalTriangle) == kTriangleBytes);
static_assert(offsetof(LocalTriangle, corners_m) == kTriangleCornersAt);

/// Largest number of batches of the surfaces of all pairs of a frame together.
constexpr std::size_t kMostBatches =
    std::size_t{kLocalSurfaces} * kMaxLocalTriangles / kPlaneLanes + kMaxNear;

/// Bound on the relative rounding of a conversion to float.
constexpr double kFloatRounding = 0x1p-22;
/// Bound on the excess of a proposed direction's length over 1 (docs/internals/proofs.md).
constexpr double kDirectionRounding = 0x1p-20;
/// Least height of the sphere over a face for which single precision decides, as a share of the
/// radius.
constexpr double kDeepest = 0x1p-6;

std::uint32_t batches_of(const LocalSurface& surface) noexcept
{
    return (surface.count + kPlaneLanes - 1) / kPlaneLanes;
}

std::uint32_t faces_in(const LocalSurface& surface, std::uint32_t batch) noexcept
{
    return std::min(kPlaneLanes, surface.count - kPlaneLanes * batch);
}

/// Lower bound on the distance of a batch's nearest face from the core, in metres of the world.
double low_of(const PlacedSurface& placed, std::uint32_t batch) noexcept
{
    const auto faces = placed.surface->distances_m.subspan(std::size_t{kPlaneLanes} * batch,
                                                           faces_in(*placed.surface, batch));
    return *std::ranges::min_element(faces) * placed.pose->scale;
}

/// Distance below which all batches fit into the list; infinite if all batches fit.
double farthest_that_fits(std::span<const PlacedSurface> surfaces) noexcept
{
    std::size_t count = 0;
    for (const PlacedSurface& placed : surfaces)
    {
        count += batches_of(*placed.surface);
    }
    if (count <= kMaxNearBatches)
    {
        return kInfinity;
    }
    StaticVector<double, kMostBatches> lows;
    double beyond = kInfinity;
    for (const PlacedSurface& placed : surfaces)
    {
        for (std::uint32_t batch = 0; batch < batches_of(*placed.surface); ++batch)
        {
            const double low = low_of(placed, batch);
            beyond = lows.try_push_back(low) ? beyond : std::min(beyond, low);
        }
    }
    auto* const first_out = lows.begin() + kMaxNearBatches;
    std::nth_element(lows.begin(), first_out, lows.end());
    return std::min(beyond, *first_out);
}

} // namespace

// NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): of the batches only the first are set.
Vicinity::Vicinity(std::span<const PlacedSurface> surfaces, Vec3 center_m, double reach_m,
                   std::uint32_t planes) noexcept
    : surfaces_(surfaces), center_m_(std::move(center_m)), reach_m_(reach_m), planes_left_(planes)
{
    TACTUS_ASSERT(reach_m >= 0.0);
    const double farthest = farthest_that_fits(surfaces);
    reach_m_ = std::min(reach_m, farthest);
    for (const PlacedSurface& placed : surfaces)
    {
        add(placed, farthest);
    }
}

void Vicinity::add(const PlacedSurface& placed, double farthest_m) noexcept
{
    TACTUS_ASSERT(placed.surface->count <= placed.surface->triangles.size());
    TACTUS_ASSERT(placed.pose->scale > 0.0);
    Part part;
    part.first = batches_;
    part.unit_m = placed.pose->scale * placed.quantum_m;
    PlaneTable& table = part.table;
    table.planes = planes_.data() + batches_;
    table.seen = seen_.data() + batches_;
    table.triangles = triangles_.data() + batches_;
    table.lows = lows_.data();
    if (!parts_.empty())
    {
        const PlaneTable& last = parts_[parts_.size() - 1].table;
        const std::size_t eights = (last.count + kPlaneLanes - 1) / kPlaneLanes;
        table.lows = last.lows + eights * kPlaneLanes;
    }
    const std::uint32_t count = batches_of(*placed.surface);
    if (count > 0)
    {
        table.center =
            make_probe(to_model(*placed.pose, center_m_), static_cast<float>(placed.quantum_m));
    }
    for (std::uint32_t batch = 0; batch < count; ++batch)
    {
        if (farthest_m == kInfinity || low_of(placed, batch) < farthest_m)
        {
            add_batch(placed, batch, table);
        }
    }
    for (std::uint32_t i = table.count; i % kPlaneLanes != 0; ++i)
    {
        table.lows[i] = kFarPlane;
    }
    parts_.push_back(part);
}

void Vicinity::add_batch(const PlacedSurface& placed, std::uint32_t batch,
                         PlaneTable& table) noexcept
{
    const std::size_t from = std::size_t{kPlaneLanes} * batch;
    const std::uint32_t faces = faces_in(*placed.surface, batch);
    const double by_quantum = (1.0 - kFloatRounding) / placed.quantum_m;
    PlaneRows& rows = planes_[batches_];
    float low = kFarPlane;
    for (std::uint32_t lane = 0; lane < kPlaneLanes; ++lane)
    {
        rows.normal[0][lane] = 0.0F;
        rows.normal[1][lane] = 0.0F;
        rows.normal[2][lane] = 0.0F;
        rows.cone[lane] = lane < faces ? 1.0F : 0.0F;
        rows.offset[lane] =
            lane < faces ? static_cast<float>(placed.surface->distances_m[from + lane] * by_quantum)
                         : kFarPlane;
        low = std::min(low, rows.offset[lane]);
    }
    table.lows[table.count++] = low;
    seen_[batches_] = {0, 0};
    triangles_[batches_] = &placed.surface->triangles[from];
    surface_[batches_] = static_cast<std::uint8_t>(parts_.size());
    faces_[batches_] = static_cast<std::uint8_t>(faces);
    ++batches_;
}

bool Vicinity::has(std::uint32_t face) const noexcept
{
    return face < size() && face % kPlaneLanes < faces_[face / kPlaneLanes];
}

const ObjectPose& Vicinity::pose_of(const Part& part) const noexcept
{
    return *surfaces_[static_cast<std::size_t>(&part - parts_.begin())].pose;
}

std::array<float, 3> Vicinity::in_quanta(const Part& part, const Vec3& place) const noexcept
{
    const Vec3 at = (pose_of(part).rotation.transpose() * place) / part.unit_m;
    return {static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z())};
}

PlaneQuestion Vicinity::question(const Part& part, const Vec3& place) const noexcept
{
    const std::array<float, 3> at = in_quanta(part, place);
    const double drift = (place - part.last_place).norm() / part.unit_m;
    return {{at[0], at[1], at[2]},
            {part.stand[0], part.stand[1], part.stand[2]},
            stand_,
            static_cast<float>(drift * (1.0 + kFloatRounding)),
            0.0F,
            0.0F};
}

/// Height of the sphere's place over a face from which the face does not restrain a motion out of
/// other faces.
double Vicinity::least_here_m(double radius_m) const noexcept
{
    return std::min(radius_m, std::max(clear_m_, kDeepest * radius_m));
}

/// Finds the batches with faces that a sphere of radius `least_m` may enter between its place and
/// `place`.
Vicinity::Hits Vicinity::find_below(Part& part, const Vec3& place, double least_m) noexcept
{
    if (part.table.count == 0)
    {
        return {};
    }
    PlaneQuestion asked = question(part, place);
    asked.least = static_cast<float>(least_m / part.unit_m * (1.0 + kFloatRounding));
    asked.least_here = asked.least;
    if (clear_m_ < least_m)
    {
        asked.least_here = static_cast<float>(least_here_m(least_m) / part.unit_m);
    }
    part.last_place = place;
    const Kernels& kernels = *surfaces_[surface_[part.first]].kernels;
    const PlaneCounts counts = kernels.planes_below(part.table, asked, hits_.data());
    use(counts.looked);
    return {hits_.data(), counts.hits};
}

double Vicinity::bound_of_surface(std::uint32_t surface, const Vec3& place) const noexcept
{
    if (surface >= parts_.size() || parts_[surface].table.count == 0)
    {
        return kInfinity;
    }
    const Part& part = parts_[surface];
    const float low = surfaces_[surface].kernels->least_height(part.table, question(part, place));
    return static_cast<double>(low) * part.unit_m;
}

void Vicinity::stand_at(const Vec3& place, const Vec3& fallback) noexcept
{
    place_ = place;
    fallback_ = fallback;
    clear_m_ = kInfinity;
    ++stand_;
    for (Part& part : parts_)
    {
        part.stand = in_quanta(part, place);
    }
}

const LocalTriangle& Vicinity::triangle(std::uint32_t face) const noexcept
{
    const auto* const first = static_cast<const LocalTriangle*>(triangles_[face / kPlaneLanes]);
    return first[face % kPlaneLanes];
}

/// Computes the face's plane as seen from `place`, in double precision.
Vicinity::Plane Vicinity::see(std::uint32_t face, const Vec3& place) const noexcept
{
    TACTUS_ASSERT(has(face));
    const PlacedSurface& placed = surfaces_[surface_of(face)];
    const ObjectPose& pose = *placed.pose;
    const Vec3 query = to_model(pose, center_m_ + place);
    const Triangle corners = to_triangle(triangle(face).corners_m);
    SeenTriangle seen; // NOLINT(cppcoreguidelines-pro-type-member-init): the kernel fills it.
    placed.kernels->see_triangle(query.data(), corners[0].data(), seen);
    const ClosestPoint closest = closest_point_seen(query, corners, seen);
    const double length = std::sqrt(closest.distance_sq);
    const Vec3 normal =
        length > 0.0 ? Vec3(pose.rotation * (closest.gap * (-1.0 / length))) : fallback_;
    return {normal, length * pose.scale - normal.dot(place)};
}

/// True if the face's plane was computed in double precision for the sphere's place.
bool Vicinity::is_seen(std::uint32_t face) const noexcept
{
    const Look& look = looks_[face % kLooks];
    return look.face == face && look.stand == stand_;
}

const Vicinity::Plane& Vicinity::look_at(std::uint32_t face) noexcept
{
    const std::uint32_t slot = face % kLooks;
    if (!is_seen(face))
    {
        use(1);
        look_planes_[slot] = see(face, place_);
        looks_[slot] = {face, stand_};
    }
    return look_planes_[slot];
}

Vicinity::Listed Vicinity::list_within(double distance_m, std::span<std::uint32_t> faces) noexcept
{
    Listed listed;
    std::uint32_t looks = 0;
    double clear_m = kInfinity;
    for (Part& part : parts_)
    {
        for (const PlaneHit& hit : find_below(part, place_, distance_m * (1.0 + kFloatRounding)))
        {
            clear_m = std::min(clear_m, static_cast<double>(hit.low) * part.unit_m);
            for (std::uint32_t lanes = hit.lanes; lanes != 0 && listed.is_all; lanes &= lanes - 1)
            {
                const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
                const std::uint32_t face = (part.first + hit.batch) * kPlaneLanes + lane;
                listed.is_all = looks < kMaxTouchLooks;
                ++looks;
                if (!listed.is_all || look_at(face).height_m(place_) > distance_m)
                {
                    continue;
                }
                listed.is_all = listed.count < faces.size();
                if (listed.is_all)
                {
                    faces[listed.count] = face;
                    ++listed.count;
                }
            }
        }
    }
    clear_m_ = clear_m;
    return listed;
}

HalfSpace<3> Vicinity::half_space(std::uint32_t face, double radius_m) noexcept
{
    const Plane& plane = look_at(face);
    return {plane.normal, radius_m - plane.height_m(place_)};
}

std::optional<std::uint32_t> Vicinity::find_entered(const Vec3& motion, double radius_m,
                                                    std::span<const std::uint32_t> passed) noexcept
{
    // The radius is 0 only for a point without any surface.
    TACTUS_ASSERT(parts_.empty() || radius_m > 0.0);
    const Vec3 place = place_ + motion;
    double deepest = radius_m * (1.0 - kContactTolerance);
    std::optional<std::uint32_t> entered;
    for (Part& part : parts_)
    {
        Hits hits = find_below(part, place, radius_m * (1.0 - kContactTolerance));
        while (!hits.empty())
        {
            const auto lowest = std::ranges::min_element(hits, {}, &PlaneHit::low);
            if (static_cast<double>(lowest->low) * part.unit_m >= deepest)
            {
                break;
            }
            const PlaneHit hit = *lowest;
            *lowest = hits.back();
            hits = hits.first(hits.size() - 1);
            for (std::uint32_t lanes = hit.lanes; lanes != 0; lanes &= lanes - 1)
            {
                const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
                const std::uint32_t face = (part.first + hit.batch) * kPlaneLanes + lane;
                if (static_cast<double>(hit.heights[lane]) * part.unit_m >= deepest ||
                    std::ranges::find(passed, face) != passed.end())
                {
                    continue;
                }
                if (is_spent() && !is_seen(face))
                {
                    return std::nullopt;
                }
                const double height = look_at(face).height_m(place);
                if (height < deepest || (height == deepest && entered && face < *entered))
                {
                    deepest = height;
                    entered = face;
                }
            }
        }
    }
    return entered;
}

/// Share of the motion, 0 .. 1, that the face's plane in single precision allows: at most the share
/// in double precision. `here` and `way` are the sphere's place and the motion in the model's
/// frame; in double precision, so that rounding turns no motion along the face into one towards it.
double Vicinity::proven_share(std::uint32_t face, const Vec3& here, const Vec3& way,
                              double radius_m) const noexcept
{
    const std::uint32_t lane = face % kPlaneLanes;
    const PlaneRows& rows = planes_[face / kPlaneLanes];
    const Vec3 normal(static_cast<double>(rows.normal[0][lane]),
                      static_cast<double>(rows.normal[1][lane]),
                      static_cast<double>(rows.normal[2][lane]));
    const double offset_m =
        static_cast<double>(rows.offset[lane]) * parts_[surface_of(face)].unit_m;
    const double height_m = (normal.dot(here) + offset_m) * (1.0 - kDirectionRounding);
    const double closing_m = -normal.dot(way);
    if (closing_m <= 0.0)
    {
        return height_m >= least_here_m(radius_m) * (1.0 - 4.0 * kDirectionRounding) ? 1.0 : 0.0;
    }
    return std::clamp((height_m - radius_m) / closing_m, 0.0, 1.0);
}

double Vicinity::free_share(const Vec3& motion, double radius_m) noexcept
{
    const double least = radius_m * (1.0 - kContactTolerance);
    const Vec3 place = place_ + motion;
    double share = 1.0;
    std::uint32_t looks = 0;
    for (Part& part : parts_)
    {
        const Mat3& rotation = pose_of(part).rotation;
        const Vec3 here = rotation.transpose() * place_;
        const Vec3 way = rotation.transpose() * motion;
        for (const PlaneHit& hit : find_below(part, place, least))
        {
            for (std::uint32_t lanes = hit.lanes; lanes != 0; lanes &= lanes - 1)
            {
                const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
                const std::uint32_t face = (part.first + hit.batch) * kPlaneLanes + lane;
                const double proven = proven_share(face, here, way, radius_m);
                if (proven >= share)
                {
                    continue;
                }
                looks += is_spent() && !is_seen(face) ? 1U : 0U;
                if (looks > kMaxTouchLooks)
                {
                    share = proven;
                    continue;
                }
                const Plane& plane = look_at(face);
                const double height = plane.height_m(place_);
                const double there = plane.height_m(place);
                if (there < least && there < height)
                {
                    share = std::min(share, std::max(0.0, height - radius_m) / (height - there));
                }
            }
        }
    }
    return share;
}

/// Iterates from place to place: the distance along the motion is convex, so the plane from each
/// place allows no more than the face does.
double Vicinity::share_before(std::uint32_t face, const Vec3& motion, double radius_m) noexcept
{
    const double least_step = kLeastStep * radius_m / motion.norm();
    double share = 0.0;
    for (std::uint32_t round = 0; round < kStepRounds; ++round)
    {
        const Vec3 place = place_ + share * motion;
        use(1);
        const Plane plane = see(face, place);
        const double closing = -plane.normal.dot(motion);
        const double gap = plane.height_m(place) - radius_m;
        if (gap >= closing * (1.0 - share))
        {
            return 1.0;
        }
        if (!(gap > 0.0))
        {
            break; // The sphere touches here; `closing` may be zero if it moves along the face.
        }
        const double step = gap / closing; // The step is less than 1 - share.
        share += step;
        if (step <= least_step)
        {
            break;
        }
    }
    return share;
}

} // namespace tactus
