// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/force/rigid_proxy.hpp"
#include "rt_core/query/contact_set.hpp"
#include "tests/shared/owned_surface.hpp"
#include "tests/shared/period.hpp"
#include "tests/unit/rt_core/surface_support.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace tactus::test
{

inline constexpr double kBodyRadius = 0.002;
inline constexpr double kBodyStiffness = 500.0;
inline const Vec3 kHalf(0.03, 0.02, 0.01);

[[nodiscard]] inline Mat3 turn(const Vec3& axis, double angle)
{
    return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

[[nodiscard]] inline ToolSpec tool_of(const ToolCore& core, double radius_m = kBodyRadius)
{
    ToolSpec spec;
    spec.radius_m = radius_m;
    spec.stiffness_n_per_m = kBodyStiffness;
    spec.force_max_n = 1e3;
    spec.torque_max_nm = 1e3;
    spec.core = core;
    return spec;
}

[[nodiscard]] inline ToolGoal hand_at(const Vec3& position_m,
                                      const Mat3& rotation = Mat3::Identity())
{
    ToolGoal hand;
    hand.position_m = position_m;
    hand.rotation = rotation;
    hand.elapsed_s = kPeriod_s;
    return hand;
}

/// An object as triangles, all of them exact.
struct Solid
{
    TriangleList triangles;
    ObjectPose pose;
    Material material{};
};

/// A proxy among objects; what it is told of them is found by trying all triangles.
class Rig
{
public:
    Rig(const ToolSpec& spec, std::vector<Solid> solids)
        : objects(std::move(solids))
        , spec_(spec)
        , memories_(objects.size())
        , stood_(objects.size())
        , sut(spec, planes_)
    {
        for (std::size_t i = 0; i < objects.size(); ++i)
        {
            stood_[i] = objects[i].pose;
        }
    }

    ToolOutput step(const Vec3& goal, const Mat3& rotation = Mat3::Identity())
    {
        return step(hand_at(goal, rotation));
    }
    ToolOutput step(const ToolGoal& hand)
    {
        sut.see(hand);
        carry();
        ToolOutput output = step_once(hand, clear);
        steps = 1;
        double left = clear;
        while (takes_steps && sut.goes_on() && !output.squeezed &&
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
    /// Of the core; zero when it meets a triangle.
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

    std::vector<Solid> objects;
    AnswerKind kind{AnswerKind::exact};
    double clear{kInfinity}; ///< Of everything else.
    double lower_share{1.0}; ///< Of the true distance, as the proxy is told.
    bool tells_corners{true};
    bool takes_steps{false};            ///< As a frame: several where the proxy would go on.
    double reach_m{0.002};              ///< Beyond the radius.
    std::uint32_t steps{0};             ///< Of the last frame.
    std::vector<Similarity> stations{}; ///< Where each of its steps ended.

private:
    void carry()
    {
        std::vector<NearObject> near;
        bool has_any_moved = false;
        for (std::size_t i = 0; i < objects.size(); ++i)
        {
            memories_[i].velocity_m_per_s = Vec3(0.0, 0.0, 0.0);
            memories_[i].spin_rad_per_s = Vec3(0.0, 0.0, 0.0);
            const ObjectPose& now = objects[i].pose;
            const bool has_moved =
                stood_[i].translation_m != now.translation_m || stood_[i].rotation != now.rotation;
            near.push_back({static_cast<std::uint32_t>(i), has_moved ? &stood_[i] : &now, &now,
                            &memories_[i]});
            has_any_moved = has_any_moved || has_moved;
        }
        sut.carry(has_any_moved ? near : std::vector<NearObject>{}, kPeriod_s);
        for (std::size_t i = 0; i < objects.size(); ++i)
        {
            stood_[i] = objects[i].pose;
        }
        stations.clear();
    }
    ToolOutput step_once(const ToolGoal& hand, double clear_m)
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
            placed.back().memory = &memories_[i];
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
                if (under.feature == TriangleFeature::interior) // It stands over the face.
                {
                    keep(corner, under.point, reach, under.feature, face, report.corners, nullptr);
                }
            }
        }
        return least;
    }
    /// As the query does: the nearest, and the ends of all.
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
    std::vector<ProxyMemory> memories_;
    std::vector<ObjectPose> stood_;
    RigidProxy::Planes planes_;

public:
    RigidProxy sut;
};

[[nodiscard]] inline Rig on_plane(const ToolCore& core, const Material& material = {})
{
    return Rig(tool_of(core), {{plane(), {}, material}});
}

} // namespace tactus::test
