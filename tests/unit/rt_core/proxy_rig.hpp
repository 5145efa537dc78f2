// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/force/proxy.hpp"
#include "rt_core/limits.hpp"
#include "tests/unit/rt_core/surface_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace tactus::test
{

inline constexpr double kRadius = 0.01;
inline constexpr double kStiffness = 500.0;
/// Remaining distance between the proxy and the reachable goal, relative to the radius.
inline constexpr double kRest = 3e-3;

[[nodiscard]] inline ToolSpec sphere_tool()
{
    ToolSpec spec;
    spec.radius_m = kRadius;
    spec.stiffness_n_per_m = kStiffness;
    spec.force_max_n = 8.0;
    return spec;
}

/// First goal, at which the proxy begins.
[[nodiscard]] inline ProxyGoal goal_at(const Vec3& position_m,
                                       const Vec3& velocity_m_per_s = Vec3(0.0, 0.0, 0.0))
{
    return {position_m, velocity_m_per_s, kPeriod_s, Mat3::Identity(), GoalChange::first};
}

[[nodiscard]] inline PlacedSurface placed_surface(const ObjectPose& pose,
                                                  const LocalSurface* surface,
                                                  const Material& material, ProxyMemory& memory,
                                                  double quantum = 1e-6)
{
    PlacedSurface placed;
    placed.pose = &pose;
    placed.surface = surface;
    placed.material = &material;
    placed.quantum_m = quantum;
    placed.memory = &memory;
    return placed;
}

/// Proxy among objects whose surfaces are certified within `certified` (model frame).
class ProxyRig : public Solids
{
public:
    ProxyRig(TriangleList list, const Vec3& start, const ObjectPose& pose = {},
             const ToolSpec& tool = sphere_tool())
        : ProxyRig(std::vector<Solid>{{std::move(list), pose}}, start, tool)
    {
    }
    ProxyRig(std::vector<Solid> solids, const Vec3& start, const ToolSpec& tool = sphere_tool())
        : Solids(std::move(solids)), sut(tool)
    {
        sut.see(goal_at(start));
    }

    ToolOutput step(const Vec3& goal, const Vec3& velocity = Vec3(0, 0, 0))
    {
        return step(goal_at(goal, velocity));
    }
    ToolOutput step(const ProxyGoal& hand)
    {
        carry(sut);
        return respond(hand, planes, false);
    }
    /// Frame of several lists, each truncated at `certified`, as in a frame.
    ToolOutput step_on(const Vec3& goal, const Vec3& velocity)
    {
        ToolOutput output;
        std::uint32_t left = planes;
        lists = 0;
        carry(sut);
        do
        {
            if (lists++ > 0)
            {
                sut.go_on();
            }
            else
            {
                sut.see({goal, velocity, kPeriod_s, Mat3::Identity(), GoalChange::motion});
            }
            output = respond(goal_at(goal, velocity), left, true);
            left = planes == Vicinity::kUnlimited ? planes : sut.planes_left();
        } while (sut.goes_on());
        return output;
    }
    ToolOutput settle(const Vec3& goal, int frames = 200)
    {
        ToolOutput output;
        for (int i = 0; i < frames; ++i)
        {
            output = step(goal);
        }
        return output;
    }
    /// Nearest point of the first object.
    [[nodiscard]] Vec3 nearest(const Vec3& point) const
    {
        ClosestPoint best;
        best.distance_sq = std::numeric_limits<double>::infinity();
        const ObjectPose& pose = objects[0].pose;
        for (const auto& corners : objects[0].triangles)
        {
            const ClosestPoint closest =
                closest_point_on_triangle(to_model(pose, point), to_triangle(corners));
            best = closest.distance_sq < best.distance_sq ? closest : best;
        }
        return to_world(pose, best.point);
    }
    [[nodiscard]] double clearance() const { return clearance_at(sut.position_m()); }
    [[nodiscard]] double clearance_at(const Vec3& place) const
    {
        double least = kInfinity;
        for (const Solid& solid : objects)
        {
            least = std::min(least, distance_to(solid.triangles, to_model(solid.pose, place)) *
                                        solid.pose.scale);
        }
        return least;
    }
    [[nodiscard]] Material& material() { return objects[0].material; }

    Proxy sut;
    double quantum{1e-6};
    double certified{0.05};
    double clear{kInfinity};                    ///< Clearance of everything else.
    std::uint32_t planes{Vicinity::kUnlimited}; ///< Planes that it may evaluate in a frame.
    std::uint32_t lists{0};                     ///< Lists of the last step_on().

private:
    ToolOutput respond(const ProxyGoal& hand, std::uint32_t left, bool is_cut)
    {
        std::vector<std::unique_ptr<OwnedSurface>> surfaces;
        std::vector<PlacedSurface> placed;
        for (std::size_t i = 0; i < objects.size(); ++i)
        {
            const Solid& solid = objects[i];
            surfaces.push_back(
                surface_of(solid.triangles, to_model(solid.pose, sut.position_m()), certified));
            surfaces.back()->is_cut = is_cut;
            placed.push_back(placed_surface(solid.pose, surfaces.back().get(), solid.material,
                                            memories[i], quantum));
            placed.back().object = static_cast<std::uint32_t>(i);
        }
        return sut.respond(hand, placed, clear, left);
    }
};

/// Cosine of the angle between two forces.
[[nodiscard]] inline double cosine(const Vec3& a, const Vec3& b)
{
    return a.dot(b) / (a.norm() * b.norm());
}

inline void expect_vector(const Vec3& is, const Vec3& should, double tolerance)
{
    EXPECT_NEAR((is - should).norm(), 0.0, tolerance)
        << is.transpose() << " instead of " << should.transpose();
}

} // namespace tactus::test
