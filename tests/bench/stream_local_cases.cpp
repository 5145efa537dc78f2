// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Prediction and cache, in virtual time: the same figures in every run.

#include "tests/bench/stream_cases.hpp"
#include "tests/bench/stream_run.hpp"

#include <algorithm>
#include <limits>

namespace tactus::bench
{

namespace
{

constexpr std::uint32_t kTaps = 40;
constexpr std::uint32_t kQuickTaps = 6;
/// Frames that the automatic choice may leave open beyond the best method.
constexpr double kAutomaticGoal = 2.0;

/// Pools besides the pages, large enough not to limit.
constexpr std::size_t kFacePool_bytes = std::size_t{4} << 20U;

StreamRun make_run(const Scene& scene, const TapTour& tour, double speed_diag_per_s,
                   std::uint32_t latency_ms, double cache_mib)
{
    StreamRun run{scene, tour, latency_ms, {}, {}};
    ToolSpec tool;
    tool.radius_m = kRadius_diag * scene.model.diagonal_m;
    tool.speed_max_m_per_s = kTourFollow * speed_diag_per_s * scene.model.diagonal_m;
    run.rig.tools = {tool};
    run.rig.cache_bytes = static_cast<std::size_t>(cache_mib * 0x1p20);
    run.rig.pool_bytes = 2 * run.rig.cache_bytes + kFacePool_bytes;
    run.budgets.splits = run.budgets.merges = tour_splits(speed_diag_per_s);
    return run;
}

TapTour make_tour(const CaseContext& context, const Scene& scene, double speed_diag_per_s,
                  double tremor_diag)
{
    TourManner manner;
    manner.speed_diag_per_s = speed_diag_per_s;
    manner.taps = context.options.quick ? kQuickTaps : kTaps;
    manner.tremor_m = tremor_diag * scene.model.diagonal_m;
    return tap_tour(scene.touch(), manner);
}

} // namespace

void run_prediction_case(const CaseContext& context, const PredictionCase& test_case)
{
    const Scene& scene = context.scenes.get(test_case.scene);
    const TapTour tour =
        make_tour(context, scene, test_case.speed_diag_per_s, test_case.tremor_diag);
    StreamRun run = make_run(scene, tour, test_case.speed_diag_per_s, test_case.latency_ms,
                             test_case.cache_mib);
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i <= kPredictions; ++i)
    {
        run.rig.prediction = static_cast<Prediction>(i);
        const StreamFigures figures = stream(run);
        Row common = context.common_row(scene.model.name, "prediction");
        common.by = prediction_name(run.rig.prediction);
        common.frames = figures.frames;
        common.hash = figures.hash;
        CaseRows rows(context.rows, common);
        const double open = figures.percent(figures.open);
        rows.add("open", open, "%");
        rows.add("late taps", static_cast<double>(figures.late_taps), "");
        rows.add("taps", static_cast<double>(figures.taps), "");
        rows.add("waiting", figures.percent(figures.waiting), "%");
        rows.add("wire", figures.per_second(figures.bytes) * 1e-3, "kB/s");
        if (run.rig.prediction == Prediction::automatic)
        {
            rows.add("open above the best", open - best, "points", kAutomaticGoal);
        }
        best = std::min(best, open);
    }
}

void run_cache_case(const CaseContext& context, const CacheCase& test_case)
{
    constexpr double kSpeed_diag_per_s = 0.5;
    constexpr std::uint32_t kLatency_ms = 20;
    const Scene& scene = context.scenes.get(test_case.scene);
    const TapTour tour = make_tour(context, scene, kSpeed_diag_per_s, 0.0);
    struct Regime
    {
        const char* name;
        double cache_mib;
        bool is_off;
        bool is_whole;
    };
    const double whole_mib = 1.5 * static_cast<double>(scene.model.faces.size()) * 64.0 * 0x1p-20;
    for (const Regime& regime : {Regime{"none", test_case.larger_mib, true, false},
                                 Regime{"small", test_case.small_mib, false, false},
                                 Regime{"larger", test_case.larger_mib, false, false},
                                 Regime{"all of it", whole_mib, false, true}})
    {
        StreamRun run = make_run(scene, tour, kSpeed_diag_per_s, kLatency_ms, regime.cache_mib);
        run.rig.cache_off = regime.is_off;
        run.rig.static_when_it_fits = regime.is_whole;
        run.rig.pool_bytes *= regime.is_whole ? 3 : 1;
        const StreamFigures figures = stream(run);
        Row common = context.common_row(scene.model.name, "cache");
        common.by = regime.name;
        common.frames = figures.frames;
        common.hash = figures.hash;
        CaseRows rows(context.rows, common);
        const auto looks = static_cast<double>(figures.hits + figures.misses);
        rows.add("pages", regime.cache_mib, "MiB");
        rows.add("hits", 100.0 * static_cast<double>(figures.hits) / std::max(looks, 1.0), "%");
        rows.add("loads", figures.per_second(figures.loads), "/s");
        rows.add("reloads", figures.per_second(figures.reloads), "/s");
        rows.add("bursts of reloads", figures.per_second(figures.reload_bursts), "/s");
        rows.add("wire", figures.per_second(figures.bytes) * 1e-3, "kB/s");
        rows.add("exact", figures.percent(figures.exact), "%");
        rows.add("open", figures.percent(figures.open), "%");
        rows.add("late taps", static_cast<double>(figures.late_taps), "");
    }
}

} // namespace tactus::bench
