// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/geometry/closest_points.hpp"
#include "rt_core/geometry/crossing.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/query/mesh_query.hpp"
#include "rt_core/query/other_surface.hpp"
#include "tests/unit/rt_core/support.hpp"
#include "tests/unit/rt_core/tree_support.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstdint>
#include <set>
#include <span>
#include <tuple>
#include <vector>

namespace tactus::test
{

/// More than any query of small trees needs.
inline constexpr WalkBudget kAmple{10'000'000, 100'000'000};

[[nodiscard]] inline MeshPlacement random_placement(Random& random)
{
    const Vec3 axis = (random.in_cube(1.0) + Vec3(2, 0, 0)).normalized();
    const Mat3 rotation = Eigen::AngleAxisd(random.between(-4.0, 4.0), axis).toRotationMatrix();
    return {{rotation, random.in_cube(0.6), random.between(0.5, 2.0)}, random.in_cube(0.5)};
}

/// Adds faces of a style, a third of them coarse unless `exact_only`.
inline void fill(TreeRig& rig, Random& random, std::uint32_t count, bool exact_only)
{
    const FaceStyle& style = face_styles()[random.below(5)];
    for (std::uint32_t prim = 0; prim < count; ++prim)
    {
        ChangedFace face = random_face(random, style, prim, 3 * prim + 1);
        face.error = exact_only ? 0 : face.error;
        rig.put(face);
    }
    rig.sut->refit();
}

/// Tool and object with this many faces, or a random number.
struct Meshes
{
    TreeRig tool{{80, 200, 200}};
    TreeRig object{{120, 300, 300}};

    explicit Meshes(Random& random, bool is_tool_exact = true, bool is_object_exact = true,
                    bool is_full = true)
    {
        fill(tool, random, is_full ? 80 : 1 + random.below(80), is_tool_exact);
        fill(object, random, is_full ? 120 : 1 + random.below(120), is_object_exact);
    }
};

[[nodiscard]] inline Triangle placed(const ChangedFace& face, const MeshPlacement& place)
{
    Triangle triangle = to_triangle(face.corners_m);
    for (Vec3& corner : triangle)
    {
        corner = place.local_to_world(corner);
    }
    return triangle;
}

[[nodiscard]] inline double error_of(const ChangedFace& face)
{
    return static_cast<double>(error_in_quanta(face.error)) * static_cast<double>(kTreeQuantum);
}

/// Largest errors of faces that count as the surface.
struct Tolerances
{
    ErrorCode tool{0};
    ErrorCode object{0};
};

/// All pairs, one by one, with the kernels that their own tests check.
struct AllPairs
{
    double lower{kInfinity};
    double upper{kInfinity};           ///< Least distance of exact faces.
    double coarse_lower{kInfinity};    ///< Pairs with a face above the tolerance, less errors.
    double tolerated_lower{kInfinity}; ///< Pairs with a coarse face within it, less errors.
    double surface{kInfinity};         ///< Least distance of faces that count as the surface.
    double corners{kInfinity};         ///< Least distance of two corners, with a tolerance.
    std::set<MeetingFaces> meeting;
    std::set<MeetingFaces> in_contact;
    std::vector<std::tuple<double, FaceId, FaceId>> contacts; ///< Contacts in no order.

    AllPairs(std::span<const ChangedFace> tool, std::span<const ChangedFace> object,
             const MeshPlacement& place, double contact, const Tolerances& tolerances = {})
        : tolerances_(tolerances)
    {
        for (const ChangedFace& tool_face : tool)
        {
            const Triangle first = placed(tool_face, place);
            for (const ChangedFace& face : object)
            {
                add(tool_face, first, face, place.place.scale, contact);
            }
        }
        lower = std::max(0.0, std::min({lower, coarse_lower, tolerated_lower}));
    }

    [[nodiscard]] Intersection intersection() const
    {
        return !meeting.empty() ? Intersection::proven
               : is_all_known() ? Intersection::none
                                : Intersection::open;
    }
    [[nodiscard]] bool is_all_known() const
    {
        return std::min(coarse_lower, tolerated_lower) > 0.0;
    }

private:
    void add(const ChangedFace& tool_face, const Triangle& first, const ChangedFace& face,
             double scale, double contact)
    {
        const Triangle second = to_triangle(face.corners_m);
        const ClosestPoints closest = closest_points(first, second);
        if ((tolerances_.tool | tolerances_.object) != 0)
        {
            add_corners(first, second);
        }
        const bool is_exact = tool_face.error == 0 && face.error == 0;
        const bool is_surface =
            tool_face.error <= tolerances_.tool && face.error <= tolerances_.object;
        if (!is_exact)
        {
            double& least = is_surface ? tolerated_lower : coarse_lower;
            least = std::min(least, closest.distance - closest.distance_error -
                                        scale * error_of(tool_face) - error_of(face));
        }
        if (!is_surface)
        {
            return;
        }
        surface = std::min(surface, closest.distance);
        if (is_exact)
        {
            lower = std::min(lower, std::max(0.0, closest.distance - closest.distance_error));
            upper = std::min(upper, closest.distance);
            if (meet(first, second))
            {
                meeting.insert({tool_face.face, face.face});
            }
        }
        if (closest.distance <= contact)
        {
            in_contact.insert({tool_face.face, face.face});
            contacts.emplace_back(closest.distance, face.face, tool_face.face);
        }
    }

    void add_corners(const Triangle& first, const Triangle& second)
    {
        for (const Vec3& corner : first)
        {
            for (const Vec3& other : second)
            {
                corners = std::min(corners, (corner - other).norm());
            }
        }
    }

    Tolerances tolerances_;
};

/// Result of a query of two meshes.
struct Asked
{
    DistanceAnswer answer;
    MeshReport report;
    ContactReport contacts;
    WalkBudget budget;
};

[[nodiscard]] inline bool same_contacts(const ContactReport& a, const ContactReport& b)
{
    return a.is_complete == b.is_complete &&
           std::ranges::equal(a.contacts, b.contacts,
                              [](const Contact& one, const Contact& other)
                              {
                                  return std::tie(one.distance_m, one.face, one.tool_face) ==
                                         std::tie(other.distance_m, other.face, other.tool_face);
                              });
}

template <typename Faces>
[[nodiscard]] std::set<MeetingFaces> as_set(const Faces& faces)
{
    return {faces.begin(), faces.end()};
}
} // namespace tactus::test
