// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/force_trajectory.hpp"

#include "host_tools/mesh/prepare.hpp"
#include "host_tools/mesh/read_mesh.hpp"
#include "tests/bench/measuring.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace tactus::bench
{

namespace
{

constexpr std::uint32_t kPositionBits = 20;
/// So much that nothing is clamped.
constexpr double kForceMax_n = 1'000.0;
constexpr double kFollow = 1.5;
constexpr double kLeastSpeed_m_per_s = 1e-3;
constexpr double kLeastPeriod_s = 1e-6;
constexpr double kMostPeriods = 1e6;

double root_mean_square(const std::vector<double>& values)
{
    double sum = 0.0;
    for (const double value : values)
    {
        sum += value * value;
    }
    return std::sqrt(sum / static_cast<double>(values.size()));
}

Result<const Scene*, SceneError> load_scene(const TrajectoryOptions& options, SceneStore& scenes)
{
    auto mesh = read_mesh(options.mesh);
    if (!mesh)
    {
        return SceneError{mesh.error().text};
    }
    NamedMesh named{options.mesh.filename().string(), std::move(mesh).value()};
    const double metres = metres_per_unit(options.mesh_unit).value();
    for (auto& position : named.mesh.positions)
    {
        std::ranges::transform(position, position.begin(), [=](double x) { return metres * x; });
    }
    return scenes.get(named, kPositionBits);
}

void add_rows(const TrajectoryOptions& options, const Trajectory& trajectory,
              const ForceTrace& trace, Rows& rows)
{
    Row common;
    common.suite = "force";
    common.part = "Trajectory";
    common.test_case = options.file.filename().string();
    common.scene = options.mesh.filename().string();
    common.frames = trace.outputs.size();
    common.hash = trace.hash;
    std::vector<double> recorded_n;
    std::vector<double> ours_n;
    std::uint64_t frozen = 0;
    std::uint64_t contacts = 0;
    for (std::size_t i = 0; i < trace.outputs.size(); ++i)
    {
        recorded_n.push_back(trajectory.samples[i].force_n.norm());
        ours_n.push_back(trace.outputs[i].force_n.norm());
        frozen += trace.outputs[i].frozen ? 1U : 0U;
        contacts += trace.outputs[i].in_contact ? 1U : 0U;
    }
    const ForceDifference difference = compare_forces(trace.outputs, trajectory);
    CaseRows line(rows, common);
    line.add("samples", static_cast<double>(trace.outputs.size()), "");
    line.add("duration", trajectory.duration_s(), "s");
    line.add("in contact", static_cast<double>(contacts), "");
    line.add("frozen", static_cast<double>(frozen), "");
    line.add("recorded force, RMS", root_mean_square(recorded_n), "N");
    line.add("our force, RMS", root_mean_square(ours_n), "N");
    line.add("force error, RMS", difference.rms_n, "N");
    line.add("force error, max", difference.max_n, "N");
    line.add("at", difference.max_time_s, "s");
}

} // namespace

ForceRun make_trajectory_run(const Scene& scene, const Trajectory& trajectory, double radius_m,
                             double stiffness_n_per_m)
{
    const auto& origin = scene.model.origin_m;
    const std::vector<TrajectorySample>& samples = trajectory.samples;
    ForceRun run{scene, {}, {}};
    std::vector<double> gaps_s;
    double speed_m_per_s = kLeastSpeed_m_per_s;
    for (std::size_t i = 0; i < samples.size(); ++i)
    {
        run.goals_m.emplace_back(samples[i].position_m - Vec3(origin[0], origin[1], origin[2]));
        if (i > 0)
        {
            gaps_s.push_back(samples[i].time_s - samples[i - 1].time_s);
            const double way_m = (samples[i].position_m - samples[i - 1].position_m).norm();
            speed_m_per_s = std::max(speed_m_per_s, way_m / gaps_s.back());
        }
    }
    const double period_s = std::max(quantile(gaps_s, 0.5), kLeastPeriod_s);
    run.period_ns = std::llround(1e9 * period_s);
    run.elapsed_periods.push_back(1);
    for (const double gap_s : gaps_s)
    {
        const double periods = std::clamp(std::round(gap_s / period_s), 1.0, kMostPeriods);
        run.elapsed_periods.push_back(static_cast<std::uint32_t>(periods));
    }
    run.tool.radius_m = radius_m;
    run.tool.stiffness_n_per_m = stiffness_n_per_m;
    run.tool.force_max_n = kForceMax_n;
    run.tool.speed_max_m_per_s = kFollow * speed_m_per_s;
    return run;
}

ForceDifference compare_forces(const std::vector<ToolOutput>& outputs, const Trajectory& trajectory)
{
    ForceDifference difference;
    std::vector<double> errors_n;
    for (std::size_t i = 0; i < outputs.size(); ++i)
    {
        const Vec3& ours_n = outputs[i].force_n;
        const TrajectorySample& sample = trajectory.samples[i];
        errors_n.push_back(trajectory.has_force_direction
                               ? (ours_n - sample.force_n).norm()
                               : std::abs(ours_n.norm() - sample.force_n.norm()));
        if (!(errors_n.back() <= difference.max_n))
        {
            difference.max_n = errors_n.back();
            difference.max_time_s = sample.time_s;
        }
    }
    difference.rms_n = root_mean_square(errors_n);
    return difference;
}

std::optional<std::string> compare_trajectory(const BenchOptions& options, Rows& rows)
{
    const TrajectoryOptions& wanted = options.trajectory;
    const auto columns = TrajectoryColumns::parse(wanted.columns);
    if (!columns)
    {
        return columns.error().text;
    }
    const auto trajectory =
        read_trajectory(wanted.file, columns.value(), metres_per_unit(wanted.unit).value());
    if (!trajectory)
    {
        return trajectory.error().text;
    }
    SceneStore scenes(options.cache);
    const auto scene = load_scene(wanted, scenes);
    if (!scene)
    {
        return scene.error().text;
    }
    const PinnedCore pinned(options.core);
    const auto trace =
        replay_forces(make_trajectory_run(*scene.value(), trajectory.value(),
                                          1e-3 * wanted.proxy_radius_mm, wanted.stiffness_n_per_m),
                      options.passes_or(1, 1));
    if (!trace)
    {
        return trace.error().text;
    }
    add_rows(wanted, trajectory.value(), trace.value(), rows);
    return std::nullopt;
}

} // namespace tactus::bench
