// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/rigid_sweeps.hpp"

#include "host_tools/shapes/shapes.hpp"
#include "tests/bench/bumpy_sphere.hpp"
#include "tests/bench/force_rows.hpp"
#include "tests/bench/measuring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tactus::bench
{

namespace
{

constexpr std::uint32_t kRigidFaces = 20'480;
constexpr std::uint32_t kTurnedFaces = 2'000; ///< Faces of plate, socket and peg.
constexpr double kRigidSpeed_m_per_s = 0.1;
/// Limits so high that nothing is clamped.
constexpr double kRigidForceMax_n = 1'000.0;
constexpr double kRigidTorqueMax_nm = 100.0;
/// Goal for the cost of friction in a frame's force stage.
constexpr double kFrictionCost_us = 10.0;
constexpr Touch kRigidTouch{2e-3, 1e-3, 1'000.0};

/// Frames of the descent, which are not counted.
constexpr std::size_t kComingFrames = 200;

/// 6-DoF tool with its path over a shape, in the shape's frame.
struct RigidCase
{
    const char* name;
    const char* shape;
    std::uint32_t faces;
    ToolCore core;
    double radius_m;
    Vec3 start_m; ///< Start of the path, above the surface.
    /// Device position by path length.
    Vec3 (*at)(double way_m);
};

/// Triangle wave between -most and most, from the middle, by path length.
double swing(double way_m, double most)
{
    const double turn = std::fmod(way_m / (4.0 * most) + 0.25, 1.0);
    return most * (1.0 - 4.0 * std::abs(turn - 0.5));
}

/// Path around the bumpy sphere of a sphere that is pressed into it.
Vec3 round_bumps(double way_m)
{
    const double angle = way_m / 0.05;
    const double u = std::cos(angle);
    const double v = std::sin(angle);
    const double depth_m = 1e-3;
    return (bumpy_radius_m(u, v, 0.0) + kRigidTouch.radius_m - depth_m) * Vec3(u, v, 0.0);
}

std::vector<RigidCase> rigid_cases()
{
    const Box box{Vec3(0.005, 0.004, 0.002)};
    const Segment capsule{{0.0, 0.0, -0.005}, {0.0, 0.0, 0.005}};
    const Segment pin{{0.0, 0.0, -0.008}, {0.0, 0.0, 0.008}};
    const Segment across{{0.0, -0.02, 0.0}, {0.0, 0.02, 0.0}};
    const Vec3 away_m(0.08, 0.0, 0.0);
    return {{"capsule of 10 mm", "bumpy-sphere", kRigidFaces, capsule, 2e-3, away_m, round_bumps},
            {"box of 10 x 8 x 4 mm", "bumpy-sphere", kRigidFaces, box, 2e-3, away_m, round_bumps},
            {"box on a plane", "plate", kTurnedFaces, box, 1e-3, Vec3(0.05, 0.045, 0.04),
             [](double way_m) { return Vec3(0.05 + swing(way_m, 0.02), 0.045, 0.012); }},
            {"box over an edge", "plate", kTurnedFaces, box, 1e-3, Vec3(0.1, 0.045, 0.04),
             [](double way_m) { return Vec3(0.1 + swing(way_m, 0.004), 0.045, 0.012); }},
            // Peg with a clearance of 0.2 mm; the device leans 1 mm towards the wall, up and down
            // and around.
            {"peg in a hole", "socket", kTurnedFaces, pin, 0.01, Vec3(0.0, 0.0, 0.06),
             [](double way_m)
             {
                 return Vec3(1e-3 * std::cos(way_m / 0.01), 1e-3 * std::sin(way_m / 0.01),
                             0.0 + swing(way_m, 0.005));
             }},
            {"cylinder across a cylinder", "peg", kTurnedFaces, across, 0.005,
             Vec3(0.04, 0.004, 0.0),
             [](double way_m) { return Vec3(0.014, 0.004, swing(way_m, 0.015)); }}};
}

ForceRun run_of(const Scene& scene, const RigidCase& rigid, double friction, std::uint32_t frames)
{
    ForceRun run{scene, {}, {}, 2 * kComingFrames};
    const auto& origin = scene.model.origin_m;
    const Vec3 origin_m(origin[0], origin[1], origin[2]);
    const double step_m = kRigidSpeed_m_per_s * kPeriod_s;
    for (std::size_t i = 0; i < run.lead_in + frames; ++i)
    {
        const double left =
            1.0 - std::min(1.0, static_cast<double>(i) / static_cast<double>(kComingFrames));
        const double way_m =
            step_m * static_cast<double>(i > kComingFrames ? i - kComingFrames : 0);
        const Vec3 goal_m = rigid.at(way_m);
        run.goals_m.push_back(goal_m + left * (rigid.start_m - goal_m) - origin_m);
    }
    run.tool.radius_m = rigid.radius_m;
    run.tool.core = rigid.core;
    run.tool.stiffness_n_per_m = kRigidTouch.stiffness_n_per_m;
    run.tool.force_max_n = kRigidForceMax_n;
    run.tool.torque_max_nm = kRigidTorqueMax_nm;
    run.tool.speed_max_m_per_s = 1.5;
    run.material.static_friction = friction;
    run.material.dynamic_friction = 0.8 * friction;
    return run;
}

void add_rigid_rows(CaseRows& rows, const ForceTrace& trace)
{
    ForceFigures figures;
    double torque_nm = 0.0;
    double torque_step_nm = 0.0;
    for (std::size_t i = 0; i < trace.outputs.size(); ++i)
    {
        const ToolOutput& output = trace.outputs[i];
        figures.without_force += output.force_n.norm() > 0.0 ? 0U : 1U;
        torque_nm = std::max(torque_nm, output.torque_nm.norm());
        if (i > 0)
        {
            const ToolOutput& last = trace.outputs[i - 1];
            figures.largest_step_n =
                std::max(figures.largest_step_n, (output.force_n - last.force_n).norm());
            torque_step_nm = std::max(torque_step_nm, (output.torque_nm - last.torque_nm).norm());
        }
    }
    add_felt_rows(rows, trace, figures, {kNoGoal, kNoGoal, kNoGoal, kNoGoal});
    rows.add("largest step", figures.largest_step_n, "N");
    rows.add("largest torque", torque_nm, "N m");
    rows.add("largest step of the torque", torque_step_nm, "N m");
}

} // namespace

void run_rigid_sweeps(const CaseContext& context)
{
    const PinnedCore pinned(context.options.core);
    for (const RigidCase& rigid : rigid_cases())
    {
        const Scene& scene = context.scenes.get(
            NamedMesh{fmt::format("{}-{}", rigid.shape, rigid.faces),
                      make_shape(parse_shape(rigid.shape).value(), rigid.faces).value()},
            kMinPositionBits);
        Spread smooth_us;
        for (const double friction : {0.0, 0.3})
        {
            const auto trace = replay_forces(
                run_of(scene, rigid, friction, context.options.frames_or(5'000, 1'000)),
                context.options.passes_or(5, 3));
            Row common = context.common_row(scene.model.name, "Rigid");
            common.test_case = fmt::format("{}{}", rigid.name, friction > 0.0 ? ", friction" : "");
            common.by = "Tactus";
            common.frames = trace.outputs.size();
            common.hash = trace.hash;
            CaseRows rows(context.rows, common);
            add_rigid_rows(rows, trace);
            const Spread force_us = spread_of(trace.force_us.least());
            if (friction > 0.0)
            {
                rows.add("friction costs, p50", force_us.p50 - smooth_us.p50, "us",
                         kFrictionCost_us);
                rows.add("friction costs, p99", force_us.p99 - smooth_us.p99, "us");
                rows.add("force.p50 by that without friction", force_us.p50 / smooth_us.p50, "x");
            }
            smooth_us = force_us;
        }
    }
}

} // namespace tactus::bench
