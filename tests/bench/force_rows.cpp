// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "tests/bench/force_rows.hpp"

#include "host_tools/shapes/shapes.hpp"
#include "platform/machine/allocation_counter.hpp"
#include "tests/bench/cases.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/static_model.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

namespace tactus::bench
{
namespace
{

constexpr double kRadius_m = 0.05;
constexpr double kBump = 0.02;
constexpr double kWaves = 8.0;

/// Limit of projections. Each leaves curvature x distance of the error, about 0.3 at worst.
constexpr int kMaxProjections = 60;
constexpr double kProjected_m = 1e-17;

constexpr std::uint32_t kLeadIn = 200;
constexpr double kLeadInHeight_m = 1e-3;

double angle_between(const Vec3& a, const Vec3& b)
{
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

Vec3 normal_of(const test::Face& face)
{
    const Vec3 first = to_vec3(face[0]);
    return (to_vec3(face[1]) - first).cross(to_vec3(face[2]) - first);
}

/// Numbers of the positions of corners; equal positions have equal numbers.
std::vector<std::uint32_t> corner_numbers(const std::vector<test::Face>& faces)
{
    const auto place = [&](std::uint32_t corner) -> const Vec3f&
    { return faces[corner / 3][corner % 3]; };
    std::vector<std::uint32_t> order(3 * faces.size());
    std::iota(order.begin(), order.end(), 0U);
    std::ranges::sort(order, {}, place);
    std::vector<std::uint32_t> numbers(order.size());
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < order.size(); ++i)
    {
        number += i > 0 && place(order[i]) != place(order[i - 1]) ? 1U : 0U;
        numbers[order[i]] = number;
    }
    return numbers;
}

Vec3 direction_at(double angle)
{
    static const Vec3 kFirst = Vec3(0.8, 0.0, -0.36).normalized();
    static const Vec3 kSecond = Vec3(0.36, 0.48, 0.8).normalized().cross(kFirst).normalized();
    return std::cos(angle) * kFirst + std::sin(angle) * kSecond;
}

Vec3 surface_point(const Vec3& direction)
{
    return bumpy_radius_m(direction.x(), direction.y(), direction.z()) * direction;
}

Vec3 above(const Vec3& surface_m, double height_m)
{
    return surface_m + height_m * bumpy_gradient(surface_m).normalized();
}

} // namespace

double bumpy_value_m(const Vec3& x)
{
    const Vec3 u = x.normalized();
    return x.norm() - bumpy_radius_m(u.x(), u.y(), u.z());
}

Vec3 bumpy_gradient(const Vec3& x)
{
    const Vec3 u = x.normalized();
    const Vec3 sine(std::sin(kWaves * u.x()), std::sin(kWaves * u.y()), std::sin(kWaves * u.z()));
    const Vec3 cosine(std::cos(kWaves * u.x()), std::cos(kWaves * u.y()), std::cos(kWaves * u.z()));
    const Vec3 slope =
        kWaves * Vec3(cosine.x() * sine.y() * sine.z(), sine.x() * cosine.y() * sine.z(),
                      sine.x() * sine.y() * cosine.z());
    return u - kRadius_m * kBump / x.norm() * (slope - u * u.dot(slope));
}

SurfaceFoot bumpy_foot(const Vec3& x)
{
    Vec3 foot = x;
    for (int i = 0; i < kMaxProjections; ++i)
    {
        const Vec3 gradient = bumpy_gradient(foot);
        const double excess = bumpy_value_m(foot) + gradient.dot(x - foot);
        const Vec3 next = x - excess / gradient.squaredNorm() * gradient;
        const double moved_m = (next - foot).norm();
        foot = next;
        if (moved_m <= kProjected_m)
        {
            break;
        }
    }
    const Vec3 normal = bumpy_gradient(foot).normalized();
    return {foot, normal, (x - foot).dot(normal)};
}

double bumpy_curvature_per_m(const Vec3& x)
{
    constexpr double kStep_m = 1e-7;
    const SurfaceFoot foot = bumpy_foot(x);
    const Vec3 first = foot.normal.unitOrthogonal();
    const Vec3 second = foot.normal.cross(first);
    const auto turn = [&](const Vec3& along) -> Vec3
    {
        const Vec3 step = kStep_m * along;
        return (bumpy_gradient(foot.point_m + step).normalized() -
                bumpy_gradient(foot.point_m - step).normalized()) /
               (2.0 * kStep_m);
    };
    const Vec3 turn_first = turn(first);
    const Vec3 turn_second = turn(second);
    const double mean = 0.5 * (turn_first.dot(first) + turn_second.dot(second));
    const double apart = 0.5 * (turn_first.dot(first) - turn_second.dot(second));
    const double twist = 0.5 * (turn_first.dot(second) + turn_second.dot(first));
    return std::abs(mean) + std::hypot(apart, twist);
}

Vec3 bumpy_force_n(const Vec3& device_m, double radius_m, double stiffness_n_per_m)
{
    const SurfaceFoot foot = bumpy_foot(device_m);
    return stiffness_n_per_m * std::max(0.0, radius_m - foot.distance_m) * foot.normal;
}

double Faceting::force_error_n(const Touch& touch) const
{
    return touch.stiffness_n_per_m * (distance_m + touch.depth_m * force_rotation_rad(touch));
}

double Faceting::force_rotation_rad(const Touch& touch) const
{
    return normal_rad / (1.0 - curvature_per_m * (touch.radius_m + touch.depth_m));
}

Faceting measure_faceting(const std::vector<test::Face>& faces,
                          const std::array<double, 3>& origin_m)
{
    const Vec3 origin(origin_m[0], origin_m[1], origin_m[2]);
    Faceting worst;
    for (const test::Face& face : faces)
    {
        const Vec3 a = origin + to_vec3(face[0]);
        const Vec3 b = origin + to_vec3(face[1]);
        const Vec3 c = origin + to_vec3(face[2]);
        const Vec3 normal = normal_of(face);
        for (const Vec3& point : {a, b, c, Vec3(0.5 * (a + b)), Vec3(0.5 * (b + c)),
                                  Vec3(0.5 * (c + a)), Vec3((a + b + c) / 3.0)})
        {
            const SurfaceFoot foot = bumpy_foot(point);
            worst.distance_m = std::max(worst.distance_m, std::abs(foot.distance_m));
            worst.normal_rad = std::max(worst.normal_rad, angle_between(normal, foot.normal));
        }
        worst.curvature_per_m = std::max(worst.curvature_per_m, bumpy_curvature_per_m(a));
    }
    worst.dihedral_rad = largest_dihedral_rad(faces);
    return worst;
}

double largest_dihedral_rad(const std::vector<test::Face>& faces)
{
    const std::vector<std::uint32_t> numbers = corner_numbers(faces);
    // Sides of faces: the ends, and the face.
    std::vector<std::pair<std::uint64_t, std::uint32_t>> sides;
    sides.reserve(numbers.size());
    for (std::uint32_t face = 0; face < faces.size(); ++face)
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            const auto [low, high] =
                std::minmax(numbers[3 * face + i], numbers[3 * face + (i + 1) % 3]);
            sides.emplace_back((std::uint64_t{low} << 32U) | high, face);
        }
    }
    std::ranges::sort(sides);
    double largest_rad = 0.0;
    for (std::size_t i = 1; i < sides.size(); ++i)
    {
        if (sides[i].first == sides[i - 1].first)
        {
            largest_rad = std::max(largest_rad, angle_between(normal_of(faces[sides[i - 1].second]),
                                                              normal_of(faces[sides[i].second])));
        }
    }
    return largest_rad;
}

Sweep make_sweep(const Touch& touch, double step_m, std::uint32_t frames)
{
    return make_sweep(touch, std::vector<double>(frames, step_m));
}

Sweep make_sweep(const Touch& touch, std::span<const double> steps_m)
{
    Sweep sweep;
    sweep.lead_in = kLeadIn;
    const double held_m = touch.radius_m - touch.depth_m;
    double angle = 0.0;
    const Vec3 start = surface_point(direction_at(angle));
    const double fall_m = (touch.depth_m + kLeadInHeight_m) / (kLeadIn - 1);
    for (std::uint32_t i = 0; i < kLeadIn; ++i)
    {
        sweep.goals_m.push_back(above(start, held_m + fall_m * (kLeadIn - 1 - i)));
        sweep.rests_m.push_back(above(start, touch.radius_m));
    }
    Vec3 last = above(start, held_m);
    for (const double step_m : steps_m)
    {
        double turn = step_m / kRadius_m;
        for (int round = 0; round < 8; ++round) // Each round leaves some per cent of the error.
        {
            const Vec3 next = above(surface_point(direction_at(angle + turn)), held_m);
            turn *= step_m / (next - last).norm();
        }
        angle += turn;
        const Vec3 surface = surface_point(direction_at(angle));
        last = above(surface, held_m);
        sweep.goals_m.push_back(last);
        sweep.rests_m.push_back(above(surface, touch.radius_m));
    }
    return sweep;
}

namespace
{

std::uint64_t hash_of(const std::vector<ToolOutput>& outputs)
{
    std::uint64_t hash = 0xCBF2'9CE4'8422'2325U;
    for (const ToolOutput& output : outputs)
    {
        for (const Vec3& vector : {output.force_n, output.proxy_m})
        {
            for (const double number : {vector.x(), vector.y(), vector.z()})
            {
                hash = (hash ^ std::bit_cast<std::uint64_t>(number)) * 0x0000'0100'0000'01B3U;
            }
        }
    }
    return hash;
}

std::unique_ptr<test::FrameRig> make_rig(const ForceRun& run)
{
    test::RigOptions options;
    options.tools = {run.tool};
    options.objects = {{ModelId{0}, run.material}};
    options.static_when_it_fits = true;
    auto rig = refined_rig(run.scene, options);
    rig->model().residence = Residence::complete;
    return rig;
}

/// One replay; outputs and planes in the order of the counted frames.
std::vector<ToolOutput> replay(const ForceRun& run, test::FrameRig& rig, ForceTrace& trace)
{
    std::vector<ToolOutput> outputs;
    std::uint64_t allocations = 0;
    StageTimer timer;
    std::array<ToolState, 1> tools;
    trace.planes.clear();
    for (std::size_t i = 0; i < run.goals_m.size(); ++i)
    {
        tools[0].position_m = run.goals_m[i];
        FrameOutput output;
        allocations += allocations_of(
            [&]
            {
                timer.begin();
                output = rig.frame().run(rig.input(tools, Budgets{}), timer.mark());
            });
        if (i >= run.lead_in)
        {
            outputs.push_back(output.tools[0]);
            trace.planes.push_back(static_cast<double>(output.work.planes_looked_at));
            trace.force_us.keep(i - run.lead_in, timer.us(Stage::force));
            trace.frame_us.keep(i - run.lead_in, timer.sum_us());
        }
    }
    if (allocation_counter::available())
    {
        trace.allocations = std::max(trace.allocations.value_or(0), allocations);
    }
    return outputs;
}

} // namespace

ForceTrace replay_forces(const ForceRun& run, std::uint32_t passes)
{
    ForceTrace trace;
    trace.force_us = LeastTimes(run.goals_m.size() - run.lead_in);
    trace.frame_us = trace.force_us;
    for (std::uint32_t pass = 0; pass < passes; ++pass)
    {
        const auto rig = make_rig(run);
        std::vector<ToolOutput> outputs = replay(run, *rig, trace);
        const std::uint64_t hash = hash_of(outputs);
        if (pass > 0 && hash != trace.hash)
        {
            throw Failure(run.scene.model.name + ": a replay of the same goals gave other forces");
        }
        trace.outputs = std::move(outputs);
        trace.hash = hash;
    }
    return trace;
}

namespace
{

/// Figures of one sweep; NaN: not reported.
struct Recorded
{
    const char* sweep;
    double p50_us, p99_us;
    double allocations;
    double error50_n, error99_n;
    double step_n;
};
constexpr double kNotTold = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<Recorded, 6> kRecorded{
    {{"82k, 0.02 m/s, 0.5 mm", 3.4, 6.9, 0.65, 0.070, 0.19, 0.25},
     {"82k, 0.1 m/s, 0.5 mm", 4.9, 9.4, 0.99, 0.072, 0.28, 0.88},
     {"82k, 0.3 m/s, 0.5 mm", 6.8, 49.0, 0.99, 0.54, 96.0, 51.0},
     {"328k, 0.1 m/s, 0.5 mm", 10.0, 18.5, 0.93, 0.275, 0.77, 4.9},
     {"1.3M, 0.1 m/s, 0.5 mm", 21.5, 50.0, 0.94, 0.201, 0.84, 2.7},
     {"1.3M, 0.1 m/s, 2 mm", 664.0, 10'383.0, 0.98, kNotTold, kNotTold, 45.0}}};

/// Length of a difference; infinite if it is not a number.
double length_of(const Vec3& difference)
{
    const double length = difference.norm();
    return std::isfinite(length) ? length : std::numeric_limits<double>::infinity();
}

} // namespace

ForceFigures measure_forces(const ForceTrace& trace, const std::vector<Vec3>& goals_m,
                            const std::vector<Vec3>& rests_m, const Touch& touch, double lag_m)
{
    ForceFigures figures;
    std::vector<double> errors_n;
    for (std::size_t i = 0; i < trace.outputs.size(); ++i)
    {
        const ToolOutput& output = trace.outputs[i];
        const Vec3 truth_n = touch.stiffness_n_per_m * (rests_m[i] - goals_m[i]);
        errors_n.push_back(length_of(output.force_n - truth_n));
        const bool is_stuck =
            output.halted || !output.in_contact || !((output.proxy_m - rests_m[i]).norm() <= lag_m);
        figures.stuck += is_stuck ? 1U : 0U;
        figures.without_force += output.force_n.norm() > 0.0 ? 0U : 1U;
        if (i > 0)
        {
            const Vec3 step_n = output.force_n - trace.outputs[i - 1].force_n;
            figures.largest_step_n = std::max(figures.largest_step_n, length_of(step_n));
        }
    }
    figures.error_n = spread_of(errors_n);
    return figures;
}

namespace
{

void add_times(CaseRows& rows, const ForceTrace& trace, const ForceGoals& goals)
{
    const Spread force_us = spread_of(trace.force_us.least());
    const Spread frame_us = spread_of(trace.frame_us.least());
    rows.add("force.p50", force_us.p50, "us");
    rows.add("force.p99", force_us.p99, "us", goal_if(goals.force_p99_us));
    rows.add("frame.p50", frame_us.p50, "us");
    rows.add("frame.p99", frame_us.p99, "us", goal_if(goals.frame_p99_us));
    if (trace.allocations)
    {
        rows.add("allocations a call",
                 static_cast<double>(*trace.allocations) /
                     static_cast<double>(trace.outputs.size()),
                 "", goals.has_laws ? std::optional(0.0) : std::nullopt);
    }
}

} // namespace

void add_felt_rows(CaseRows& rows, const ForceTrace& trace, const ForceFigures& figures,
                   const ForceGoals& goals)
{
    add_times(rows, trace, goals);
    rows.add("frames without force", static_cast<double>(figures.without_force), "",
             goals.has_laws ? std::optional(0.0) : std::nullopt);
}

void add_lag_rows(CaseRows& rows, const ForceTrace& trace, std::size_t slows_at)
{
    double largest_m = 0.0;
    double cut_short = 0.0;
    double back_ms = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < trace.outputs.size(); ++i)
    {
        const ToolOutput& output = trace.outputs[i];
        largest_m = std::max(largest_m, output.lag_m);
        cut_short += output.cut_short ? 1.0 : 0.0;
        if (i >= slows_at && output.in_contact && !output.halted && !output.under_way)
        {
            back_ms = std::min(back_ms, 1e3 * kPeriod_s * static_cast<double>(i - slows_at));
        }
    }
    const Spread planes = spread_of(trace.planes);
    rows.add("frames cut short", cut_short, "");
    rows.add("planes.p99", planes.p99, "");
    rows.add("planes.max", planes.max, "");
    rows.add("largest lag", 1e3 * largest_m, "mm");
    rows.add("on the hand again after", back_ms, "ms", kReturn_ms);
}

void add_force_rows(CaseRows& rows, const ForceTrace& trace, const ForceFigures& figures,
                    const ForceGoals& goals, std::optional<double> coarser_p99_n)
{
    add_times(rows, trace, goals);
    const std::optional<double> law = goals.has_laws ? std::optional(0.0) : std::nullopt;
    rows.add("error.p50", figures.error_n.p50, "N");
    rows.add("error.p99", figures.error_n.p99, "N", goal_if(goals.error_p99_n));
    rows.add("error.max", figures.error_n.max, "N", goal_if(goals.error_max_n));
    rows.add("largest step", figures.largest_step_n, "N", goal_if(goals.step_n));
    rows.add("stuck frames", static_cast<double>(figures.stuck), "", law);
    if (coarser_p99_n)
    {
        rows.add("error p99 by the coarser mesh's", figures.error_n.p99 / *coarser_p99_n, "x", 1.0);
    }
}

void add_recorded_peer(Rows& rows)
{
    for (const Recorded& recorded : kRecorded)
    {
        Row common;
        common.suite = "force";
        common.part = "Sweeps";
        common.test_case = recorded.sweep;
        common.by = "CHAI3D 3.3, recorded elsewhere";
        common.scene = "a bumpy sphere of its own";
        CaseRows line(rows, common);
        line.add("frame.p50", recorded.p50_us, "us");
        line.add("frame.p99", recorded.p99_us, "us");
        line.add("allocations a call", recorded.allocations, "");
        line.add("error.p50", recorded.error50_n, "N");
        line.add("error.p99", recorded.error99_n, "N");
        line.add("largest step", recorded.step_n, "N");
    }
}

} // namespace tactus::bench
