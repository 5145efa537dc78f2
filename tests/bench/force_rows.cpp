// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/force_rows.hpp"

#include "tests/bench/cases.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tactus::bench
{

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
