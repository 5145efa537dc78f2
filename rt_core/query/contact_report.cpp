// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/query/contact_report.hpp"

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/geometry/placed_core.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/arc_tangent.hpp"
#include "rt_core/query/contact_set.hpp"
#include "rt_core/query/convex_contact.hpp"
#include "rt_core/records/local_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace tactus
{

namespace
{

/// Face with a corner at the nearest point, and the index of that corner.
struct IncidentFace
{
    FaceId face{};
    std::uint32_t triangle{0};
    std::size_t corner{0};
};

using Incident = StaticVector<IncidentFace, kMaxIncidentFaces>;

/// Angle between two vectors by Kahan's half-angle formula, accurate at any angle. Zero if a vector
/// has no length.
double angle_between(const Vec3& a, const Vec3& b) noexcept
{
    const Vec3 u = unit_or_zero(a);
    const Vec3 v = unit_or_zero(b);
    const double apart = (u - v).norm();
    const double together = (u + v).norm();
    return together > 0.0 ? 2.0 * arc_tangent(apart / together)
                          : (apart > 0.0 ? std::numbers::pi : 0.0);
}

/// Finds normal and side at the nearest point of one surface.
class NearestFeature
{
public:
    NearestFeature(const AbTree& tree, const LocalSurface& surface) noexcept
        : tree_(tree), surface_(surface)
    {
    }

    /// Finds the normal at the nearest point; false if it is not known.
    [[nodiscard]] bool try_find_normal(Vec3& normal) noexcept
    {
        const DistanceAnswer& answer = surface_.answer;
        const std::uint32_t nearest = find(answer.nearest_face);
        if (!is_known(answer.kind) || answer.upper_m > answer.certified_radius_m ||
            nearest == surface_.count)
        {
            return false;
        }
        switch (answer.nearest_feature)
        {
        case TriangleFeature::interior:
            normal = normal_of(triangle(nearest));
            is_manifold_ = true;
            break;
        case TriangleFeature::edge_0:
        case TriangleFeature::edge_1:
        case TriangleFeature::edge_2:
            normal = of_edge(nearest, static_cast<std::size_t>(answer.nearest_feature) - 3);
            break;
        default:
            normal = of_vertex(nearest, static_cast<std::size_t>(answer.nearest_feature));
        }
        return normal != Vec3(0.0, 0.0, 0.0);
    }

    /// True if the faces round the nearest point form a disc.
    [[nodiscard]] bool is_manifold() const noexcept { return is_manifold_; }

private:
    using Corners = std::array<Vec3f, 3>;

    [[nodiscard]] std::uint32_t find(FaceId face) const noexcept
    {
        std::uint32_t i = 0;
        while (i < surface_.count &&
               (face.is_none() || tree_.face_of(surface_.triangles[i].prim) != face))
        {
            ++i;
        }
        return i;
    }
    [[nodiscard]] const Corners& corners(std::uint32_t i) const noexcept
    {
        TACTUS_ASSERT(i < surface_.count);
        return surface_.triangles[i].corners_m;
    }
    [[nodiscard]] Triangle triangle(std::uint32_t i) const noexcept
    {
        return to_triangle(corners(i));
    }

    /// Collects the faces with a corner at `at`, ordered by id so that sums have the same bits.
    /// False if they don't fit.
    [[nodiscard]] bool try_gather(const Vec3f& at, Incident& incident) const noexcept
    {
        for (std::uint32_t i = 0; i < surface_.count; ++i)
        {
            const auto* const found = std::find(corners(i).begin(), corners(i).end(), at);
            if (found == corners(i).end())
            {
                continue;
            }
            if (!incident.try_push_back({tree_.face_of(surface_.triangles[i].prim), i,
                                         static_cast<std::size_t>(found - corners(i).begin())}))
            {
                return false;
            }
            for (std::size_t k = incident.size() - 1;
                 k > 0 && incident[k].face < incident[k - 1].face; --k)
            {
                std::swap(incident[k], incident[k - 1]);
            }
        }
        return true;
    }

    [[nodiscard]] Vec3 of_edge(std::uint32_t nearest, std::size_t edge) noexcept
    {
        const Vec3f from = corners(nearest)[edge];
        const Vec3f to = corners(nearest)[(edge + 1) % 3];
        Incident incident;
        if (!try_gather(from, incident))
        {
            return {0.0, 0.0, 0.0};
        }
        Vec3 sum(0.0, 0.0, 0.0);
        std::uint32_t along = 0;
        std::uint32_t against = 0;
        for (const IncidentFace& face : incident)
        {
            const bool goes_along = corners(face.triangle)[(face.corner + 1) % 3] == to;
            const bool goes_against = corners(face.triangle)[(face.corner + 2) % 3] == to;
            along += goes_along ? 1U : 0U;
            against += goes_against ? 1U : 0U;
            if (goes_along || goes_against)
            {
                sum += normal_of(triangle(face.triangle));
            }
        }
        is_manifold_ = along == 1 && against == 1;
        return unit_or_zero(sum);
    }

    [[nodiscard]] Vec3 of_vertex(std::uint32_t nearest, std::size_t corner) noexcept
    {
        const Vec3f at = corners(nearest)[corner];
        Incident incident;
        if (!try_gather(at, incident))
        {
            return {0.0, 0.0, 0.0};
        }
        Vec3 sum(0.0, 0.0, 0.0);
        for (const IncidentFace& face : incident)
        {
            const Triangle here = triangle(face.triangle);
            const Vec3 first = here[(face.corner + 1) % 3] - here[face.corner];
            const Vec3 second = here[(face.corner + 2) % 3] - here[face.corner];
            const double angle = angle_between(first, second);
            sum += angle * normal_of(here);
        }
        is_manifold_ = is_one_fan(incident);
        return unit_or_zero(sum);
    }

    /// True if the faces at a vertex form one closed fan, with no face left over.
    [[nodiscard]] bool is_one_fan(const Incident& incident) const noexcept
    {
        std::size_t at = 0;
        for (std::size_t step = 1; step <= incident.size(); ++step)
        {
            const IncidentFace& face = incident[at];
            const Vec3f& out = corners(face.triangle)[(face.corner + 2) % 3];
            std::size_t next = incident.size();
            std::size_t continuing = 0;
            for (std::size_t i = 0; i < incident.size(); ++i)
            {
                if (corners(incident[i].triangle)[(incident[i].corner + 1) % 3] == out)
                {
                    next = i;
                    ++continuing;
                }
            }
            if (continuing != 1)
            {
                return false;
            }
            at = next;
            if (at == 0)
            {
                return step == incident.size();
            }
        }
        return false;
    }

    const AbTree& tree_;
    const LocalSurface& surface_;
    bool is_manifold_{false};
};

/// Closest points of core and triangle. libccd decides whether a convex body meets the triangle if
/// the bounds leave that open.
ClosestPoints closest_of(const PlacedCore& core, const Triangle& triangle,
                         ContactReport& report) noexcept
{
    if (!core.is_convex_body())
    {
        return core.closest(triangle);
    }
    Vec3 direction(0.0, 0.0, 0.0);
    const ConvexContact contact = contact_of(core.body(), triangle, direction);
    report.overruled += contact.is_ccd_overruled ? 1U : 0U;
    ClosestPoints closest = to_closest_points(contact.nearest);
    closest.meet = contact.meet;
    return closest;
}

/// Faces of a surface within a distance, as indices into it. Faces that may be among the nearest
/// kMaxContacts come first: once they are measured, few others need a measurement.
class NearFirst
{
public:
    NearFirst(const LocalSurface& surface, const AbTree& tree, double within_m) noexcept
    {
        Places all;
        for (std::uint32_t i = 0; i < surface.count; ++i)
        {
            if (surface.distances_m[i] <= within_m)
            {
                all.push_back(static_cast<std::uint16_t>(i));
            }
        }
        if (all.size() <= kMaxContacts)
        {
            places_ = all;
            return;
        }
        const auto rank = [&](std::uint16_t i)
        { return std::pair(surface.distances_m[i], tree.face_of(surface.triangles[i].prim)); };
        Places ranked = all;
        std::ranges::nth_element(ranked, ranked.begin() + kMaxContacts, {}, rank);
        const auto first_after = rank(ranked[kMaxContacts]);
        for (const bool is_near : {true, false})
        {
            for (const std::uint16_t i : all)
            {
                if ((rank(i) < first_after) == is_near)
                {
                    places_.push_back(i);
                }
            }
        }
    }

    [[nodiscard]] const std::uint16_t* begin() const noexcept { return places_.begin(); }
    [[nodiscard]] const std::uint16_t* end() const noexcept { return places_.end(); }

private:
    using Places = StaticVector<std::uint16_t, kMaxLocalTriangles>;
    static_assert(kMaxLocalTriangles <= 0xFFFF);

    Places places_;
};

/// True if a contact of this face, at least `distance_m` away, would be kept in `contacts`.
bool may_be_kept(double distance_m, FaceId face, const ContactSet& contacts) noexcept
{
    return !contacts.full() || comes_before(Contact{.face = face, .distance_m = distance_m},
                                            contacts[kMaxContacts - 1]);
}

void add_contacts(const PlacedCore& core, double radius_m, const AbTree& tree,
                  const LocalSurface& surface, ContactReport& report) noexcept
{
    for (const std::uint16_t i : NearFirst(surface, tree, radius_m))
    {
        const FaceId face = tree.face_of(surface.triangles[i].prim);
        if (!report.is_complete && !may_be_kept(surface.distances_m[i], face, report.contacts))
        {
            continue;
        }
        const Triangle triangle = to_triangle(surface.triangles[i].corners_m);
        const ClosestPoints closest = closest_of(core, triangle, report);
        if (closest.distance > radius_m && !closest.meet)
        {
            continue;
        }
        if (!keep_nearest(make_contact(closest, triangle, face), report.contacts))
        {
            report.is_complete = false;
        }
    }
}

bool is_over(const Vec3& point, const Triangle& triangle, const Vec3& normal) noexcept
{
    for (std::size_t i = 0; i < 3; ++i)
    {
        const Vec3 edge = triangle[(i + 1) % 3] - triangle[i];
        if (edge.cross(point - triangle[i]).dot(normal) < 0.0)
        {
            return false;
        }
    }
    return true;
}

/// Upper bound on the distance of the triangle's points from its first corner.
double size_of(const Triangle& triangle) noexcept
{
    return kWidened * std::sqrt(std::max((triangle[1] - triangle[0]).squaredNorm(),
                                         (triangle[2] - triangle[0]).squaredNorm()));
}

/// True if one of the points, within `reach_m` of the triangle's plane, may be over the triangle.
bool may_be_over(const CoreCorners& points, double reach_m, const Triangle& triangle,
                 double size_m) noexcept
{
    const double far_m = kWidened * (reach_m + size_m);
    return std::ranges::any_of(points, [&](const Vec3& point)
                               { return (point - triangle[0]).squaredNorm() <= far_m * far_m; });
}

/// Adds contacts of the core's corners that are over a face, on either side.
void add_corners(const CoreCorners& corners, double reach_m, const Triangle& triangle, FaceId face,
                 TouchReport& touches) noexcept
{
    const Vec3 normal = normal_of(triangle);
    for (const Vec3& corner : corners)
    {
        const double height = normal.dot(corner - triangle[0]);
        const double distance = std::abs(height);
        if (!(distance > 0.0) || distance > reach_m || !is_over(corner, triangle, normal))
        {
            continue;
        }
        const Contact contact{
            face,   TriangleFeature::interior, distance,
            corner, corner - height * normal,  height > 0.0 ? normal : Vec3(-normal),
            {}};
        const bool has_room = keep_nearest(contact, touches.corners);
        touches.is_truncated = touches.is_truncated || !has_room;
    }
}

/// True if a contact of the triangle, at least `distance_m` away, may be an end in some direction.
bool may_be_an_end(const Triangle& triangle, double size_m, double distance_m,
                   const ContactEnds& ends) noexcept
{
    return ends.is_empty ||
           (may_be_farther_in_any(triangle, size_m, distance_m, ends.reaches_m) &&
            is_farther_in_any(most_end_reaches(triangle, distance_m), ends.reaches_m));
}

/// Adds the slab of a face that is `distance_m` away, without a measurement. False, with nothing
/// added, if the separating plane proves less than kHardlyLess of that distance.
bool try_add_slab(const PlacedCore& core, const Triangle& triangle, double distance_m,
                  TouchReport& touches) noexcept
{
    constexpr double kHardlyLess = 0.95;
    const CoreSeparation plane = core.separation(triangle);
    const bool proves_it = plane.distance > 0.0 && plane.distance >= kHardlyLess * distance_m;
    if (proves_it)
    {
        keep_slab(plane.normal, plane.distance, touches);
    }
    return proves_it;
}

/// Adds the slab of a measured face: each shape is on its own side of the plane across the two
/// nearest points. If the points are too inaccurate, the slab covers all directions.
void add_slab(const Vec3& normal, const ClosestPoints& closest, TouchReport& touches) noexcept
{
    constexpr double kWellFound = 1e-6;
    const double lower_m = std::max(0.0, closest.distance - closest.distance_error);
    const bool is_found = !closest.meet && closest.distance_error <= kWellFound * closest.distance;
    keep_slab(is_found ? normal : Vec3(0.0, 0.0, 0.0), lower_m, touches);
}

} // namespace

void report_touches(const PlacedCore& core, double reach_m, const AbTree& tree,
                    const LocalSurface& surface, TouchReport& touches) noexcept
{
    TACTUS_ASSERT(reach_m >= 0.0);
    TACTUS_ASSERT(surface.count <= surface.triangles.size());
    touches.clear();
    touches.covered_m = reach_m;
    const CoreCorners corners = core.corners();
    for (const std::uint16_t i : NearFirst(surface, tree, reach_m))
    {
        const Triangle triangle = to_triangle(surface.triangles[i].corners_m);
        const FaceId face = tree.face_of(surface.triangles[i].prim);
        const double lower_m = surface.distances_m[i];
        const double size_m = size_of(triangle);
        if (may_be_over(corners, reach_m, triangle, size_m))
        {
            add_corners(corners, reach_m, triangle, face, touches);
        }
        const bool is_of_use = !touches.is_truncated ||
                               may_be_kept(lower_m, face, touches.nearest) ||
                               may_be_an_end(triangle, size_m, lower_m, touches.ends);
        if (!is_of_use && try_add_slab(core, triangle, lower_m, touches))
        {
            continue;
        }
        const ClosestPoints closest = core.closest(triangle);
        if (closest.distance <= reach_m)
        {
            const Contact contact = make_contact(closest, triangle, face);
            add_slab(contact.normal, closest, touches);
            keep_ends(contact, touches.ends);
            const bool has_room = keep_nearest(contact, touches.nearest);
            touches.is_truncated = touches.is_truncated || !has_room;
        }
    }
}

void report_contacts(const PlacedCore& core, double radius_m, const AbTree& tree,
                     const LocalSurface& surface, bool is_closed, ContactReport& report) noexcept
{
    TACTUS_ASSERT(radius_m >= 0.0);
    TACTUS_ASSERT(surface.count <= surface.triangles.size());
    report.clear();
    const DistanceAnswer& answer = surface.answer;
    // No unseen face may touch: all faces are exact up to the radius, or all surface is farther.
    report.is_complete = answer.certified_radius_m >= radius_m || answer.lower_m > radius_m;
    add_contacts(core, radius_m, tree, surface, report);
    NearestFeature nearest(tree, surface);
    if (!nearest.try_find_normal(report.normal) || !is_closed || !nearest.is_manifold() ||
        !(answer.lower_m > 0.0))
    {
        return;
    }
    const double height = report.normal.dot(answer.tool_point_m - answer.nearest_point_m);
    report.side = height > 0.0   ? Side::outside
                  : height < 0.0 ? Side::inside
                                 : Side::unsigned_distance;
}

} // namespace tactus
