// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/force/placed_surface.hpp"
#include "rt_core/force/proxy_goal.hpp"
#include "rt_core/records/frame_output.hpp"
#include "tests/shared/distance_oracle.hpp"
#include "tests/shared/owned_surface.hpp"
#include "tests/shared/period.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace tactus::test
{

using TriangleList = std::vector<std::array<Vec3f, 3>>;

/// Square of two triangles, counter-clockwise from its first corner.
inline void add_square(TriangleList& list, const Vec3& a, const Vec3& b, const Vec3& c,
                       const Vec3& d)
{
    list.push_back({to_float(a), to_float(b), to_float(c)});
    list.push_back({to_float(a), to_float(c), to_float(d)});
}

/// Plane z = 0, 2 m wide.
[[nodiscard]] inline TriangleList plane()
{
    TriangleList list;
    add_square(list, {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
    return list;
}

/// Surface of the cube of half edge `half` around the origin, seen from both sides.
[[nodiscard]] inline TriangleList cube(double half)
{
    TriangleList list;
    for (Eigen::Index axis = 0; axis < 3; ++axis)
    {
        for (const double side : {-half, half})
        {
            const auto corner = [&](double u, double v)
            {
                Vec3 point;
                point[axis] = side;
                point[(axis + 1) % 3] = u * half;
                point[(axis + 2) % 3] = v * half;
                return point;
            };
            add_square(list, corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1));
        }
    }
    return list;
}

/// Least distance from a point to the triangles.
[[nodiscard]] inline double distance_to(const TriangleList& list, const Vec3& point)
{
    double least = std::numeric_limits<double>::infinity();
    for (const auto& corners : list)
    {
        least = std::min(
            least, static_cast<double>(DistanceOracle::distance(point, to_triangle(corners))));
    }
    return least;
}

/// Answer of a query at `center_m` for these triangles, with all in `certified_m` exact.
[[nodiscard]] inline std::unique_ptr<OwnedSurface>
surface_of(const TriangleList& list, const Vec3& center_m, double certified_m)
{
    auto surface = std::make_unique<OwnedSurface>();
    surface->center_m = center_m;
    surface->answer.certified_radius_m = certified_m;
    surface->answer.lower_m = std::max(0.0, std::min(certified_m, distance_to(list, center_m)));
    for (std::uint32_t i = 0; i < list.size(); ++i)
    {
        const auto d =
            static_cast<double>(DistanceOracle::distance(center_m, to_triangle(list[i])));
        if (d <= certified_m)
        {
            surface->triangles[surface->count] = {PrimId{i}, list[i]};
            surface->distances_m[surface->count++] = std::max(0.0, d * (1.0 - 1e-14));
        }
    }
    return surface;
}

[[nodiscard]] inline Mat3 turn(const Vec3& axis, double angle)
{
    return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

/// Axis times the angle of the rotation.
[[nodiscard]] inline Vec3 turned_between(const Mat3& from, const Mat3& to)
{
    const Eigen::AngleAxisd turned(to * from.transpose());
    return turned.angle() * turned.axis();
}

[[nodiscard]] inline ProxyGoal hand_at(const Vec3& position_m,
                                       const Mat3& rotation = Mat3::Identity())
{
    ProxyGoal hand;
    hand.position_m = position_m;
    hand.rotation = rotation;
    hand.elapsed_s = kPeriod_s;
    return hand;
}

/// Object of triangles, all exact.
struct Solid
{
    TriangleList triangles;
    ObjectPose pose{};
    Material material{};
};

/// Objects, the proxy's memory of each, and their poses in the previous frame.
struct Solids
{
    explicit Solids(std::vector<Solid> solids)
        : objects(std::move(solids)), memories(objects.size()), stood(objects.size())
    {
        std::ranges::transform(objects, stood.begin(), &Solid::pose);
    }

    /// Informs the proxy if an object has moved since the last frame.
    template <typename AnyProxy>
    void carry(AnyProxy& proxy)
    {
        std::vector<NearObject> near;
        bool has_any_moved = false;
        for (std::size_t i = 0; i < objects.size(); ++i)
        {
            memories[i].velocity_m_per_s = memories[i].spin_rad_per_s = Vec3(0.0, 0.0, 0.0);
            const ObjectPose& now = objects[i].pose;
            const bool has_moved =
                stood[i].translation_m != now.translation_m || stood[i].rotation != now.rotation;
            near.push_back(
                {static_cast<std::uint32_t>(i), has_moved ? &stood[i] : &now, &now, &memories[i]});
            has_any_moved = has_any_moved || has_moved;
        }
        proxy.carry(has_any_moved ? near : std::vector<NearObject>{}, kPeriod_s);
        std::ranges::transform(objects, stood.begin(), &Solid::pose);
    }

    std::vector<Solid> objects;
    std::vector<ProxyMemory> memories;
    std::vector<ObjectPose> stood;
};

/// Work of force and torque on a hand in `rounds` rounds of a closed path.
template <typename AnyRig, typename Hand>
double work_of_rounds(AnyRig& rig, const Hand& hand_of, int round, int rounds = 2)
{
    double work_j = 0.0;
    ProxyGoal before = hand_of(0);
    ToolOutput last = rig.step(before);
    for (int step = 1; step <= rounds * round; ++step)
    {
        const ProxyGoal hand = hand_of(step);
        const ToolOutput now = rig.step(hand);
        work_j += 0.5 * (now.force_n + last.force_n).dot(hand.position_m - before.position_m) +
                  0.5 * (now.torque_nm + last.torque_nm)
                            .dot(turned_between(before.rotation, hand.rotation));
        last = now;
        before = hand;
    }
    return work_j;
}

} // namespace tactus::test
