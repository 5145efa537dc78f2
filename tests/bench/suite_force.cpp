// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Suite `force`: forces on a surface where they are known (docs/benchmarks/suites.md). A device
/// sweeps around the bumpy sphere, 1 mm below the rest position of the proxy's centre.

#include "host_tools/shapes/shapes.hpp"
#include "tests/bench/force_rows.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/suites.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <memory>
#include <utility>
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

/// A capsule and a box sweep around the bumpy sphere, a box over a plane and its edge, a peg in its
/// hole and a cylinder across another one, each with and without friction: times, rendered forces
/// and torques, and the cost of friction.
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

constexpr double kDepth_m = 1e-3;
constexpr double kStiffness_n_per_m = 1'000.0;
/// Proxy speed limit of all sweeps, above the fastest one, since paths over bumps and edges are
/// longer.
constexpr double kSpeedMax_m_per_s = 1.5;
/// Limit so high that nothing is clamped and errors show in full.
constexpr double kForceMax_n = 1'000.0;
/// Allowed error of a force besides the mesh's own error, as a share of it.
constexpr double kTolerance = 0.02;
/// Goals in newtons are valid up to this speed.
constexpr double kGoalSpeed_m_per_s = 0.3;

/// A speed with the goals of the stage's and the frame's p99: 2 mm on the finest mesh.
struct SpeedCase
{
    double speed_m_per_s;
    double force_us;
    double frame_us;
};
constexpr std::array<SpeedCase, 4> kSpeeds{
    {{0.02, 7.0, 20.0}, {0.1, 12.0, 20.0}, {0.3, 16.0, 20.0}, {1.0, 22.0, 40.0}}};
/// Speeds with friction, and the goals.
constexpr double kFriction = 0.3;
constexpr double kDynamicShare = 0.8;
constexpr std::array<SpeedCase, 2> kRoughSpeeds{{{0.3, kNoGoal, 35.0}, {1.0, kNoGoal, 60.0}}};
/// Speed above the usual one of a hand on a surface, with a device that permits it to the proxy.
/// Then the hand slows down.
constexpr SpeedCase kFast{3.0, kNoGoal, kNoGoal};
constexpr double kSlow_m_per_s = 1.0;
constexpr std::uint32_t kSlowFrames = 200;
constexpr double kFastSpeedMax_m_per_s = 5.0;
constexpr std::array<double, 2> kRadii_m{0.5e-3, 2e-3};

struct MeshCase
{
    const char* name;
    When when;
    std::uint32_t faces;
    std::uint32_t position_bits;
    double error_p99_n{kNoGoal};
    bool has_goals{true};
};
/// Rounding of the corners on a grid of 16 bits, 2 um, rotates the faces of the finest mesh
/// by about 10 mrad; with 20 bits by less than one.
constexpr std::array<MeshCase, 6> kMeshes{{{"5k", When::always, 5'120, 16},
                                           {"20k", When::always, 20'480, 16},
                                           {"82k", When::always, 81'920, 16, 0.1},
                                           {"328k", When::full_only, 327'680, 16},
                                           {"1.3M", When::full_only, 1'310'720, 20, 0.03},
                                           {"tiny", When::named_only, 1'280, 16, kNoGoal, false}}};
constexpr const char* kFinest = "1.3M";

/// Error p99 of the last mesh's sweeps, by speed and radius.
using CoarserErrors = std::map<std::pair<double, double>, double>;

struct SweepContext : CaseContext
{
    const MeshCase& mesh;
    const Scene& scene;
    const Faceting& faceting;
    CoarserErrors& coarser;
};

NamedMesh bumpy_mesh(std::uint32_t faces, std::uint32_t bits, double scale)
{
    return {fmt::format("bumpy-sphere-{}{}{}", faces,
                        bits == kMinPositionBits ? "" : fmt::format("-{}bit", bits),
                        scale == 1.0 ? "" : fmt::format("-x{:.0f}", scale)),
            scaled(make_shape(Shape::bumpy_sphere, faces).value(), scale)};
}

/// Points of a sweep in the frame of a scene that is `scale` times as large.
std::vector<Vec3> in_model(const std::vector<Vec3>& points_m, const Scene& scene, double scale)
{
    const auto& origin = scene.model.origin_m;
    std::vector<Vec3> moved;
    std::ranges::transform(points_m, std::back_inserter(moved),
                           [&](const Vec3& point) -> Vec3
                           { return scale * point - Vec3(origin[0], origin[1], origin[2]); });
    return moved;
}

std::vector<Vec3> counted(const std::vector<Vec3>& points_m, std::size_t lead_in)
{
    return {points_m.begin() + static_cast<std::ptrdiff_t>(lead_in), points_m.end()};
}

ForceRun make_run(const Scene& scene, const Sweep& sweep, const Touch& touch, double scale)
{
    ForceRun run{scene, {}, in_model(sweep.goals_m, scene, scale), sweep.lead_in};
    run.tool.radius_m = scale * touch.radius_m;
    run.tool.stiffness_n_per_m = touch.stiffness_n_per_m / scale;
    run.tool.force_max_n = kForceMax_n;
    run.tool.speed_max_m_per_s = scale * kSpeedMax_m_per_s;
    return run;
}

/// True if goals of times exist for the mesh and the sphere.
bool is_timed(const SweepContext& context, double radius_m)
{
    return context.mesh.name == std::string(kFinest) && radius_m > 1e-3;
}

ForceGoals goals_of(const SweepContext& context, const Touch& touch, const SpeedCase& speed)
{
    if (!context.mesh.has_goals)
    {
        return {kNoGoal, kNoGoal, kNoGoal, kNoGoal, false};
    }
    const bool has_times = is_timed(context, touch.radius_m);
    const double speed_m_per_s = speed.speed_m_per_s;
    const double error_n = context.faceting.force_error_n(touch) + kTolerance * touch.force_n();
    const double step_n = touch.stiffness_n_per_m * speed_m_per_s * kPeriod_s +
                          touch.force_n() * context.faceting.dihedral_rad;
    return {has_times ? speed.frame_us : kNoGoal,
            speed_m_per_s <= kGoalSpeed_m_per_s ? context.mesh.error_p99_n : kNoGoal,
            error_n,
            step_n,
            true,
            has_times ? speed.force_us : kNoGoal};
}

void run_sweep(const SweepContext& context, double radius_m, const SpeedCase& speed)
{
    const Touch touch{radius_m, kDepth_m, kStiffness_n_per_m};
    const double speed_m_per_s = speed.speed_m_per_s;
    const double step_m = speed_m_per_s * kPeriod_s;
    const Sweep sweep = make_sweep(touch, step_m, context.options.frames_or(10'000, 2'000));
    const ForceRun run = make_run(context.scene, sweep, touch, 1.0);
    const auto trace = replay_forces(run, context.options.passes_or(5, 3));
    const ForceGoals goals = goals_of(context, touch, speed);
    // The sphere may be one period behind the device, and off by the error of the mesh.
    const double lag_m = step_m + context.faceting.force_error_n(touch) / touch.stiffness_n_per_m +
                         kTolerance * touch.depth_m;
    const ForceFigures figures = measure_forces(
        trace, counted(run.goals_m, run.lead_in),
        counted(in_model(sweep.rests_m, context.scene, 1.0), run.lead_in), touch, lag_m);
    Row common = context.common_row(context.scene.model.name, "Sweeps");
    common.test_case += fmt::format(", {} m/s, {} mm", speed_m_per_s, 1e3 * radius_m);
    common.by = "Tactus";
    common.frames = trace.outputs.size();
    common.hash = trace.hash;
    CaseRows rows(context.rows, common);
    const auto coarser = context.coarser.find({speed_m_per_s, radius_m});
    const bool is_finer = context.mesh.has_goals && coarser != context.coarser.end();
    add_force_rows(rows, trace, figures, goals,
                   is_finer ? std::optional(coarser->second) : std::nullopt);
    context.coarser[{speed_m_per_s, radius_m}] = figures.error_n.p99;
}

/// Sweep without a known true force: with friction, or with a device faster than the proxy.
void run_felt_sweep(const SweepContext& context, const SpeedCase& speed, double friction,
                    double speed_max_m_per_s)
{
    const Touch touch{kRadii_m.back(), kDepth_m, kStiffness_n_per_m};
    const bool is_fast = speed.speed_m_per_s > kSpeedMax_m_per_s;
    std::vector<double> steps_m(context.options.frames_or(10'000, 2'000),
                                speed.speed_m_per_s * kPeriod_s);
    const std::size_t slows_at = steps_m.size();
    steps_m.insert(steps_m.end(), is_fast ? kSlowFrames : 0, kSlow_m_per_s * kPeriod_s);
    const Sweep sweep = make_sweep(touch, steps_m);
    ForceRun run = make_run(context.scene, sweep, touch, 1.0);
    run.tool.speed_max_m_per_s = speed_max_m_per_s;
    run.material.static_friction = friction;
    run.material.dynamic_friction = kDynamicShare * friction;
    const auto trace = replay_forces(run, context.options.passes_or(5, 3));
    const ForceFigures figures = measure_forces(
        trace, counted(run.goals_m, run.lead_in),
        counted(in_model(sweep.rests_m, context.scene, 1.0), run.lead_in), touch, kNoGoal);
    Row common = context.common_row(context.scene.model.name, "Sweeps");
    common.test_case += fmt::format(", {} m/s, {} mm", speed.speed_m_per_s, 1e3 * touch.radius_m);
    common.test_case += friction > 0.0 ? fmt::format(", friction {}", friction) : "";
    common.by = "Tactus";
    common.frames = trace.outputs.size();
    common.hash = trace.hash;
    CaseRows rows(context.rows, common);
    add_felt_rows(rows, trace, figures,
                  {speed.frame_us, kNoGoal, kNoGoal, kNoGoal, true, speed.force_us});
    if (is_fast)
    {
        add_lag_rows(rows, trace, slows_at);
    }
}

void run_felt_sweeps(const SweepContext& context)
{
    for (const SpeedCase& speed : kRoughSpeeds)
    {
        run_felt_sweep(context, speed, kFriction, kSpeedMax_m_per_s);
    }
    for (const double friction : {0.0, kFriction})
    {
        run_felt_sweep(context, kFast, friction, kFastSpeedMax_m_per_s);
    }
}

void add_mesh_rows(const SweepContext& context)
{
    CaseRows rows(context.rows, context.common_row(context.scene.model.name, "Meshes"));
    rows.add("faces", static_cast<double>(context.scene.model.faces.size()), "");
    rows.add("position bits", context.mesh.position_bits, "");
    rows.add("off the surface", 1e6 * context.faceting.distance_m, "um");
    rows.add("turned", 1e3 * context.faceting.normal_rad, "mrad");
    rows.add("largest dihedral", 1e3 * context.faceting.dihedral_rad, "mrad");
    for (const double radius_m : kRadii_m)
    {
        rows.add(fmt::format("force error it allows, {} mm", 1e3 * radius_m),
                 context.faceting.force_error_n({radius_m, kDepth_m, kStiffness_n_per_m}), "N");
    }
}

void run_mesh(const CaseContext& of_case, const MeshCase& mesh, CoarserErrors& coarser)
{
    const Scene& scene =
        of_case.scenes.get(bumpy_mesh(mesh.faces, mesh.position_bits, 1.0), mesh.position_bits);
    const Faceting faceting = measure_faceting(scene.model.faces, scene.model.origin_m);
    const SweepContext context{of_case, mesh, scene, faceting, coarser};
    add_mesh_rows(context);
    const PinnedCore pinned(context.options.core);
    for (const double radius_m : kRadii_m)
    {
        for (const SpeedCase& speed : kSpeeds)
        {
            run_sweep(context, radius_m, speed);
        }
    }
    if (is_timed(context, kRadii_m.back()))
    {
        run_felt_sweeps(context);
    }
}

/// Forces of one sweep on the coarsest mesh with all lengths multiplied by `scale` and the
/// stiffness divided by it.
ForceTrace scaled_forces(SceneStore& scenes, std::uint32_t frames, double scale)
{
    const Touch touch{kRadii_m[0], kDepth_m, kStiffness_n_per_m};
    const Scene& scene =
        scenes.get(bumpy_mesh(kMeshes[0].faces, kMaxPositionBits, scale), kMaxPositionBits);
    const Sweep sweep = make_sweep(touch, kSpeeds[1].speed_m_per_s * kPeriod_s, frames);
    return replay_forces(make_run(scene, sweep, touch, scale), 1);
}

/// A power of two changes no bit. Any other factor rounds differently: corners by one part in 2^24
/// of the box, which with the proxy's tolerances stays below a thousandth of the force.
void run_units(const CaseContext& context)
{
    const std::uint32_t frames = context.options.frames_or(10'000, 2'000);
    const auto metres = scaled_forces(context.scenes, frames, 1.0);
    for (const double scale : {1'024.0, 1'000.0})
    {
        const auto scaled = scaled_forces(context.scenes, frames, scale);
        double largest_n = 0.0;
        std::uint64_t others = 0;
        for (std::size_t i = 0; i < frames; ++i)
        {
            const Vec3& here = metres.outputs[i].force_n;
            const Vec3& there = scaled.outputs[i].force_n;
            largest_n = std::max(largest_n, (there - here).norm());
            others += there == here ? 0U : 1U;
        }
        const std::string lengths = fmt::format("all lengths x {:.0f}", scale);
        Row common = context.common_row(lengths, "Units");
        common.test_case = lengths;
        common.frames = frames;
        common.hash = scaled.hash;
        CaseRows lines(context.rows, common);
        const bool is_exact = std::exp2(std::round(std::log2(scale))) == scale;
        const double tolerance_n = 1e-3 * kStiffness_n_per_m * kDepth_m;
        lines.add("frames with another force", static_cast<double>(others), "",
                  is_exact ? std::optional(0.0) : std::nullopt);
        lines.add("largest difference", largest_n, "N", is_exact ? 0.0 : tolerance_n);
    }
}

std::vector<Case> force_cases()
{
    std::vector<Case> cases;
    const auto coarser = std::make_shared<CoarserErrors>();
    for (const MeshCase& mesh : kMeshes)
    {
        cases.push_back({mesh.name, mesh.when, [&mesh, coarser](const CaseContext& context) {
                             run_mesh(context, mesh, *coarser);
                         }});
    }
    cases.push_back({"rigid", When::always, run_rigid_sweeps});
    cases.push_back({"sheets", When::always, run_sheet_tools});
    cases.push_back({"dense", When::always, run_dense_meshes});
    cases.push_back({"units", When::always, run_units});
    cases.push_back({"recorded", When::always,
                     [](const CaseContext& context) { add_recorded_peer(context.rows); }});
    return cases;
}

} // namespace

Suite force_suite()
{
    return {"force", force_cases, true};
}

} // namespace tactus::bench
