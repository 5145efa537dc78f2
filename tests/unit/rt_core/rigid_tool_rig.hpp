// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/force/rigid_proxy.hpp"
#include "rt_core/query/contact_set.hpp"
#include "tests/unit/rt_core/surface_support.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace tactus::test
{

inline constexpr double kRigidRadius = 0.002;
inline constexpr double kRigidStiffness = 500.0;
inline const Vec3 kHalf(0.03, 0.02, 0.01);

[[nodiscard]] inline ToolSpec tool_of(const ToolCore& core, double radius_m = kRigidRadius)
{
    ToolSpec spec;
    spec.radius_m = radius_m;
    spec.stiffness_n_per_m = kRigidStiffness;
    spec.force_max_n = 1e3;
    spec.torque_max_nm = 1e3;
    spec.core = core;
    return spec;
}

/// Proxy among objects, with contacts found by trying all triangles.
class Rig : public Solids
{
public:
    Rig(const ToolSpec& spec, std::vector<Solid> solids)
        : Solids(std::move(solids)), spec_(spec), sut(spec, planes_)
    {
    }

    ToolOutput step(const Vec3& goal, const Mat3& rotation = Mat3::Identity())
    {
        return step(hand_at(goal, rotation));
    }
    ToolOutput step(const ProxyGoal& hand)
    {
        sut.see(hand);
        carry(sut);
        stations.clear();
        ToolOutput output = step_once(hand, clear);
        steps = 1;
        double left = clear;
        while (takes_steps && sut.goes_on() && !output.over_constrained &&
               steps < RigidProxy::kStepsPerFrame)
        {
            left -= sut.went_m();
            sut.go_on();
            output = step_once(hand, left);
            ++steps;
        }
        return output;
    }
    ToolOutput settle(const Vec3& goal, const Mat3& rotation = Mat3::Identity(), int frames = 300)
    {
        ToolOutput output;
        for (int i = 0; i < frames; ++i)
        {
            output = step(goal, rotation);
        }
        return output;
    }
    /// Distance of the core; zero if it meets a triangle.
    [[nodiscard]] double distance() const { return distance_at(sut.place()); }
    [[nodiscard]] double distance_at(const Similarity& place) const
    {
        double least = std::numeric_limits<double>::infinity();
        for (const Solid& solid : objects)
        {
            TouchReport unused;
            least = std::min(least, look(solid, place, unused));
        }
        return least;
    }

    AnswerKind kind{AnswerKind::exact};
    double clear{kInfinity}; ///< Clearance of everything else.
    double lower_share{1.0}; ///< Reported lower bound as a share of the true distance.
    bool tells_corners{true};
    bool takes_steps{false}; ///< Takes several steps in a frame if the proxy would continue.
    double reach_m{0.002};   ///< Reach beyond the radius.
    std::uint32_t steps{0};  ///< Steps of the last frame.
    std::vector<Similarity> stations{}; ///< Ends of its steps.

private:
    ToolOutput step_once(const ProxyGoal& hand, double clear_m)
    {
        std::vector<TouchReport> reports(objects.size());
        std::vector<OwnedSurface> surfaces(objects.size());
        std::vector<PlacedSurface> placed;
        for (std::size_t i = 0; i < objects.size(); ++i)
        {
            const double lower = look(objects[i], sut.place(), reports[i]);
            if (!tells_corners)
            {
                reports[i].corners.clear();
            }
            surfaces[i].answer.kind = kind;
            surfaces[i].answer.lower_m = lower_share * lower;
            surfaces[i].answer.certified_radius_m = sut.radius_m() + reach_m;
            placed.push_back({&objects[i].pose, &surfaces[i], &objects[i].material, 0.0, 0.0,
                              lower_share * lower, &reports[i]});
            placed.back().object = static_cast<std::uint32_t>(i);
            placed.back().memory = &memories[i];
        }
        const ToolOutput output = sut.respond(hand, placed, clear_m);
        stations.push_back(sut.place());
        return output;
    }
    [[nodiscard]] double look(const Solid& solid, const Similarity& place,
                              TouchReport& report) const
    {
        const PlacedCore core(spec_.core, place);
        const double reach = sut.radius_m() + reach_m;
        report.covered_m = reach;
        double least = std::numeric_limits<double>::infinity();
        std::uint32_t face = 0;
        for (const auto& corners : solid.triangles)
        {
            ++face;
            Triangle triangle = to_triangle(corners);
            for (Vec3& corner : triangle)
            {
                corner = to_world(solid.pose, corner);
            }
            const ClosestPoints closest = core.closest(triangle);
            const double distance = closest.meet ? 0.0 : closest.distance;
            least = std::min(least, distance);
            keep(closest.on_shape, closest.on_triangle, reach, closest.feature, face,
                 report.nearest, tells_corners ? &report.ends : nullptr);
            if (distance <= reach)
            {
                keep_slab(unit_or_zero(closest.on_shape - closest.on_triangle), distance, report);
            }
            for (const Vec3& corner : core.corners())
            {
                const auto under = closest_point_on_triangle(corner, triangle);
                if (under.feature == TriangleFeature::interior) // The point is above the face.
                {
                    keep(corner, under.point, reach, under.feature, face, report.corners, nullptr);
                }
            }
        }
        return least;
    }
    /// Selection like the query's: the nearest, and the extremes of all.
    static void keep(const Vec3& on_tool, const Vec3& on_surface, double reach,
                     TriangleFeature feature, std::uint32_t face, ContactSet& set,
                     ContactEnds* ends)
    {
        const Vec3 gap = on_tool - on_surface;
        if (gap.norm() > 0.0 && gap.norm() <= reach)
        {
            const Contact contact{FaceId{face}, feature,          gap.norm(), on_tool,
                                  on_surface,   gap.normalized(), FaceId{}};
            (void)keep_nearest(contact, set);
            if (ends != nullptr)
            {
                keep_ends(contact, *ends);
            }
        }
    }

    ToolSpec spec_;
    RigidProxy::Planes planes_;

public:
    RigidProxy sut;
};

[[nodiscard]] inline Rig on_plane(const ToolCore& core, const Material& material = {})
{
    return Rig(tool_of(core), {{plane(), {}, material}});
}

} // namespace tactus::test
