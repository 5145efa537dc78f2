// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Suite `frame`: the goals' table. Lists the cases with their goals; the cases' own files measure
/// them.

#include "tests/bench/cases.hpp"
#include "tests/bench/frame_replay.hpp"
#include "tests/bench/instruction_count.hpp"
#include "tests/bench/judged_queries.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/static_model.hpp"
#include "tests/bench/suites.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>

namespace tactus::bench
{
namespace
{

/// Goals in microseconds.
struct FrameCase
{
    SceneSource scene;
    double speed_diag_per_s;
    std::uint32_t splits;   ///< Limit K of splits and of merges.
    std::size_t pool_bytes; ///< Pools including tables, inbox and the loader's copies.
    double p50, p99, max;
    double cold_max{kNoGoal};
    /// Goals for T_R + T_B, in instructions.
    double counted_p99{kNoGoal}, counted_max{kNoGoal};
    double counted_mean{kNoGoal}; ///< Goal for the mean of whole frames, in instructions.
};

/// Goal in MiB.
struct MemoryCase
{
    SceneSource scene;
    double speed_diag_per_s;
    std::uint32_t splits;
    double pool_mib;
};

/// Goals as shares of the peer's time.
struct StaticCase
{
    SceneSource scene;
    double near_p50{kNoGoal}, near_p99{kNoGoal};
    double flight_p99{kNoGoal};
    double warmed_p99{kNoGoal}; ///< Goal as a share of our own warm p99.
};

struct GrowthCase
{
    double growth; ///< Goal for p50 with the most faces divided by p50 with the fewest.
};

// Whole frames: a tool slides over a model that streams into small pools.

constexpr double kSplitGoal_us = 0.25;
constexpr double kPeerTolerance_diag = 2e-6;
/// Share of the slide that is measured cold, at its start: eviction takes 5 ms a frame.
constexpr std::size_t kColdShare = 4;

CaseRows rows_of(const CaseContext& context, const Scene& scene, std::size_t frames,
                 std::uint64_t hash)
{
    Row common = context.common_row(scene.model.name);
    common.frames = frames;
    common.hash = hash;
    return {context.rows, common};
}

/// Query time of the first peer alone, with the whole mesh in memory, for the same positions.
std::optional<Spread> peer_spread(const FrameRun& run, std::uint32_t passes, std::string& name)
{
    const auto peers = make_peers(run.scene.model.faces);
    if (peers.empty())
    {
        return std::nullopt;
    }
    name = peers[0]->name();
    const auto first = run.goals_m.begin() + static_cast<std::ptrdiff_t>(run.lead_in);
    const Questions questions = ask(run.scene, {first, run.goals_m.end()});
    const double diagonal_m = run.scene.model.diagonal_m;
    const auto times = time_queries(*peers[0], questions, 2.0 * kRadius_diag * diagonal_m,
                                    kPeerTolerance_diag * diagonal_m, passes);
    return spread_of(times.us.least());
}

constexpr Spread kNoGoals{kNoGoal, kNoGoal, kNoGoal};

void add_spread(CaseRows& rows, const std::string& figure, const Spread& spread,
                const Spread& goals, const char* unit = "us")
{
    rows.add(figure + ".p50", spread.p50, unit, goal_if(goals.p50));
    rows.add(figure + ".p99", spread.p99, unit, goal_if(goals.p99));
    rows.add(figure + ".max", spread.max, unit, goal_if(goals.max));
}

void add_warm(CaseRows& rows, const FrameReplay& replay, const FrameCase& test_case,
              const std::optional<Spread>& peer, const std::string& peer_name)
{
    const Spread spread = spread_of(replay.sum_us(CacheState::warm).least());
    const auto add = [&](const char* metric, double value, double goal, double Spread::*part)
    {
        Row& row = rows.add(metric, value, "us", goal_if(goal));
        if (peer)
        {
            row.peer = peer_name + " query";
            row.peer_value = peer.value().*part;
        }
    };
    add("frame warm.p50", spread.p50, test_case.p50, &Spread::p50);
    add("frame warm.p99", spread.p99, test_case.p99, &Spread::p99);
    add("frame warm.max", spread.max, test_case.max, &Spread::max);
    rows.add("frame warm.raw_max", replay.sum_us(CacheState::warm).raw_max(), "us");
    constexpr std::array<const char*, kStages> kNames{"T_L load", "T_R refine", "T_B refit",
                                                      "T_Q query", "force"};
    for (std::size_t stage = 0; stage < kStages; ++stage)
    {
        add_spread(rows, kNames[stage],
                   spread_of(replay.stage_us(static_cast<Stage>(stage)).least()), kNoGoals);
    }
}

void add_cold(CaseRows& rows, const FrameReplay& replay, CacheState caches, double max_goal,
              std::size_t frames)
{
    const std::vector<double>& all = replay.sum_us(caches).least();
    const auto end = all.begin() + static_cast<std::ptrdiff_t>(std::min(frames, all.size()));
    const std::string figure = caches == CacheState::cold ? "frame cold" : "frame warmed";
    add_spread(rows, figure, spread_of({all.begin(), end}), {kNoGoal, kNoGoal, max_goal});
    rows.add(figure + ".raw_max", replay.sum_us(caches).raw_max(), "us");
}

void add_work(CaseRows& rows, const FrameReplay& replay, std::size_t pool_bytes)
{
    const FrameWork& work = replay.work();
    if (const double split_us = replay.split_us(); split_us > 0.0)
    {
        rows.add("split, all in", split_us, "us", kSplitGoal_us);
    }
    rows.add("splits", work.per_frame(work.counters.splits), "/frame");
    add_spread(rows, "splits", spread_of(replay.splits()), kNoGoals, "");
    rows.add("nodes", work.per_frame(work.counters.nodes_visited), "/frame");
    rows.add("triangles", work.per_frame(work.counters.triangles_tested), "/frame");
    rows.add("in contact", 100.0 * work.per_frame(work.contacts), "%");
    rows.add("uncertified contacts", 100.0 * work.per_frame(work.uncertified), "%");
    rows.add("open answers", 100.0 * work.per_frame(work.open), "%");
    rows.add("pools", static_cast<double>(pool_bytes) * 0x1p-20, "MiB");
    rows.add("pages used at most", work.model.pages.used_max, "");
    rows.add("faces used at most", work.model.faces.used_max, "");
}

/// A tool slides over a streamed model. Measures T_L + T_R + T_B + T_Q, warm, cold and with warmed
/// caches, and with --instructions those of a frame and of T_R + T_B.
void run_frame_case(const CaseContext& context, const FrameCase& test_case)
{
    const Scene& scene = context.scenes.get(test_case.scene);
    const PinnedCore pinned(context.options.core);
    const std::uint32_t frames = context.options.frames_or(6'000, 1'500);
    const std::uint32_t passes = context.options.passes_or(5, 3);
    const FrameRun run = make_slide(scene, test_case.speed_diag_per_s, test_case.splits,
                                    test_case.pool_bytes, frames);
    FrameReplay replay(run);
    replay.run(passes);
    CaseRows rows = rows_of(context, scene, run.counted(), replay.hash());
    if (context.options.count)
    {
        add_warm(rows, replay, test_case, std::nullopt, "");
        add_work(rows, replay, test_case.pool_bytes);
        return;
    }
    std::string peer_name;
    const auto peer = peer_spread(run, passes, peer_name);
    add_warm(rows, replay, test_case, peer, peer_name);
    const std::size_t cold_frames = frames / kColdShare;
    for (const CacheState caches : {CacheState::cold, CacheState::warmed})
    {
        replay.run(caches, std::min(passes, 2U), cold_frames);
        add_cold(rows, replay, caches, caches == CacheState::cold ? test_case.cold_max : kNoGoal,
                 cold_frames);
    }
    add_work(rows, replay, test_case.pool_bytes);
    std::vector<double> counted;
    double counted_frames = 0.0;
    for (const StageCounts& stages : count_stages(context))
    {
        const auto of = [&stages](Stage stage) { return stages[static_cast<std::size_t>(stage)]; };
        counted.push_back(static_cast<double>(of(Stage::refine) + of(Stage::refit)));
        counted_frames +=
            static_cast<double>(std::accumulate(stages.begin(), stages.end(), std::uint64_t{0}));
    }
    if (!counted.empty())
    {
        rows.add("frame", counted_frames / static_cast<double>(counted.size()), "instructions",
                 goal_if(test_case.counted_mean));
        add_spread(rows, "T_R + T_B", spread_of(counted),
                   {kNoGoal, test_case.counted_p99, test_case.counted_max}, "instructions");
    }
}

/// Finds the smallest of a series of pools with which a slide has an exact answer in every frame in
/// contact.
void run_memory_case(const CaseContext& context, const MemoryCase& test_case)
{
    static constexpr std::array<double, 7> kTried_mib{2.5, 3.0, 3.5, 4.0, 6.0, 8.0, 16.0};
    const Scene& scene = context.scenes.get(test_case.scene);
    const PinnedCore pinned(context.options.core);
    const std::uint32_t frames = context.options.frames_or(3'000, 1'000);
    double enough_mib = std::numeric_limits<double>::quiet_NaN();
    for (const double mib : kTried_mib)
    {
        const FrameRun run = make_slide(scene, test_case.speed_diag_per_s, test_case.splits,
                                        static_cast<std::size_t>(mib * 0x1p20), frames);
        FrameReplay replay(run);
        replay.run(1);
        const FrameWork& work = replay.work();
        const bool is_enough = work.contacts > 0 && work.uncertified == 0;
        if (is_enough || mib == kTried_mib.back())
        {
            CaseRows rows = rows_of(context, scene, run.counted(), replay.hash());
            rows.add("pools", is_enough ? mib : enough_mib, "MiB", test_case.pool_mib);
            rows.add("in contact", 100.0 * work.per_frame(work.contacts), "%");
            rows.add("uncertified contacts", static_cast<double>(work.uncertified), "frames");
            rows.add("pages used at most", work.model.pages.used_max, "");
            rows.add("faces used at most", work.model.faces.used_max, "");
            break;
        }
    }
}

// Queries of a static model: one sphere in the touching motion, compared with the peers, over
// trees of the whole mesh.

constexpr double kStaticNear_diag = 2.0 * kRadius_diag;
/// Tolerances: ours is exact to rounding, the peers use float on coordinates of about a diagonal.
constexpr double kOurTolerance_diag = 1e-9;
constexpr std::uint32_t kColdFrames = 1'000;

Questions touch_questions(const CaseContext& context, const Scene& scene)
{
    const std::uint32_t frames = context.options.frames_or(4 * kCycleFrames, kCycleFrames);
    return ask(scene, touch_motion(scene.touch(), frames));
}

/// Times for the same questions; ours first, then the peers'.
std::vector<QueryTimes> time_all(const CaseContext& context, TactusQuery& ours,
                                 const std::vector<std::unique_ptr<PointQuery>>& peers,
                                 const Scene& scene, const Questions& questions, double band_m)
{
    const std::uint32_t passes = context.options.passes_or(5, 3);
    std::vector<QueryTimes> all;
    auto mine =
        time_queries(ours, questions, band_m, kOurTolerance_diag * scene.model.diagonal_m, passes);
    all.push_back(std::move(mine));
    for (const std::unique_ptr<PointQuery>& peer : peers)
    {
        auto theirs = time_queries(*peer, questions, band_m,
                                   kPeerTolerance_diag * scene.model.diagonal_m, passes);
        all.push_back(std::move(theirs));
    }
    return all;
}

/// Adds our quantiles and the first peer's, with the share as the goal; the other peers have their
/// own rows.
void add_against_peers(CaseRows& rows, const std::string& figure,
                       const std::vector<QueryTimes>& times,
                       const std::vector<std::unique_ptr<PointQuery>>& peers,
                       const std::vector<bool>& choice, double p50_share, double p99_share)
{
    const Spread ours = spread_of(chosen(times[0].us.least(), choice));
    std::optional<Spread> peer;
    if (!peers.empty())
    {
        peer = spread_of(chosen(times[1].us.least(), choice));
    }
    const auto add = [&](const char* quantile, double Spread::*part, double share)
    {
        const auto goal = peer ? goal_if(share * peer.value().*part) : std::nullopt;
        Row& row = rows.add(figure + quantile, ours.*part, "us", goal);
        if (peer)
        {
            row.peer = peers[0]->name();
            row.peer_value = peer.value().*part;
        }
    };
    add(".p50", &Spread::p50, p50_share);
    add(".p99", &Spread::p99, p99_share);
    add(".max", &Spread::max, kNoGoal);
    rows.add(figure + ".raw_max", times[0].us.raw_max(), "us");
}

/// Adds the work of a near question, the same on every machine.
void add_near_work(CaseRows& rows, TactusQuery& ours, const Questions& questions,
                   const std::vector<bool>& near, double band_m)
{
    double asked = 0.0;
    double nodes = 0.0;
    double triangles = 0.0;
    double sum_m = 0.0;
    for (std::size_t i = 0; i < near.size(); ++i)
    {
        const std::uint64_t nodes_before = ours.nodes_visited();
        const std::uint64_t triangles_before = ours.triangles_tested();
        sum_m += ours.distance_m(questions.points_m[i], band_m);
        if (near[i])
        {
            asked += 1.0;
            nodes += static_cast<double>(ours.nodes_visited() - nodes_before);
            triangles += static_cast<double>(ours.triangles_tested() - triangles_before);
        }
    }
    const volatile double used = sum_m;
    static_cast<void>(used);
    rows.add("T_Q near, nodes and blocks", nodes / asked, "a question");
    rows.add("T_Q near, triangles", triangles / asked, "a question");
}

/// Times of near questions with evicted caches, optionally warmed.
Spread cold_spread(TactusQuery& ours, const Questions& questions, const std::vector<bool>& near,
                   double band_m, bool warmed)
{
    CacheEvictor evictor;
    std::vector<double> times_us;
    double sum_m = 0.0;
    for (std::size_t i = 0; i < near.size() && times_us.size() < kColdFrames; ++i)
    {
        if (!near[i])
        {
            continue;
        }
        sum_m += ours.distance_m(questions.points_m[i > 0 ? i - 1 : 0], band_m);
        evictor.evict();
        if (warmed)
        {
            ours.warm_caches();
        }
        const BenchClock::time_point start = BenchClock::now();
        sum_m += ours.distance_m(questions.points_m[i], band_m);
        times_us.push_back(microseconds(start, BenchClock::now()));
    }
    const volatile double used = sum_m;
    static_cast<void>(used);
    return spread_of(times_us);
}

/// Queries of the touching motion against a fully refined model, compared with the peers.
void run_static_case(const CaseContext& context, const StaticCase& test_case)
{
    const Scene& touched = context.scenes.get(test_case.scene);
    const PinnedCore pinned(context.options.core);
    StaticModel model(touched);
    const auto peers = context.options.count ? std::vector<std::unique_ptr<PointQuery>>{}
                                             : make_peers(touched.model.faces);
    const Questions questions = touch_questions(context, touched);
    const double band_m = kStaticNear_diag * touched.model.diagonal_m;
    const std::vector<bool> near = questions.nearer_than(band_m);
    TactusQuery ours(model.tree());
    const auto banded = time_all(context, ours, peers, touched, questions, band_m);
    const auto unbounded =
        time_all(context, ours, peers, touched, questions, std::numeric_limits<double>::infinity());
    const std::uint64_t hash = banded[0].hash + 3 * unbounded[0].hash;
    CaseRows rows = rows_of(context, touched, questions.points_m.size(), hash);
    add_against_peers(rows, "T_Q near", banded, peers, near, test_case.near_p50,
                      test_case.near_p99);
    add_against_peers(rows, "T_Q exact flight", unbounded, peers,
                      std::vector<bool>(near.size(), true), kNoGoal, test_case.flight_p99);
    add_near_work(rows, ours, questions, near, band_m);
    if (!context.options.count)
    {
        const double warm_p99 = quantile(chosen(banded[0].us.least(), near), 0.99);
        add_spread(rows, "T_Q near, warmed", cold_spread(ours, questions, near, band_m, true),
                   {kNoGoal, test_case.warmed_p99 * warm_p99, kNoGoal});
        add_spread(rows, "T_Q near, cold", cold_spread(ours, questions, near, band_m, false),
                   kNoGoals);
    }
}

/// The same near queries on four sizes of the bumpy sphere.
void run_growth_case(const CaseContext& context, const GrowthCase& test_case)
{
    static constexpr std::array<SceneSource, 4> kSizes{
        SceneSource{"growth-4k", nullptr, 0, 4'000}, SceneSource{"growth-40k", nullptr, 0, 40'000},
        SceneSource{"growth-400k", nullptr, 0, 400'000},
        SceneSource{"growth-4M", nullptr, 0, 4'000'000}};
    std::vector<double> p50_us;
    for (const SceneSource& size : kSizes)
    {
        const Scene& touched = context.scenes.get(size);
        const PinnedCore pinned(context.options.core);
        StaticModel model(touched);
        const auto peers = make_peers(touched.model.faces);
        const Questions questions = touch_questions(context, touched);
        const double band_m = kStaticNear_diag * touched.model.diagonal_m;
        TactusQuery ours(model.tree());
        const auto times = time_all(context, ours, peers, touched, questions, band_m);
        const std::vector<bool> near = questions.nearer_than(band_m);
        CaseRows rows = rows_of(context, touched, near.size(), times[0].hash);
        add_against_peers(rows, "T_Q near", times, peers, near, kNoGoal, kNoGoal);
        add_near_work(rows, ours, questions, near, band_m);
        p50_us.push_back(quantile(chosen(times[0].us.least(), near), 0.5));
        if (&size == &kSizes.back())
        {
            rows.add("growth 4 k to 4 M", p50_us.back() / p50_us.front(), "x", test_case.growth);
        }
    }
}

void run_clock_case(const CaseContext& context)
{
    CaseRows(context.rows, context.common_row("none")).add("two readings", clock_cost_us(), "us");
}

/// Rows of the goals' table, in order.
std::vector<Case> frame_cases()
{
    const auto frame = [](const char* name, When when, const FrameCase& test_case)
    { return make_case(name, when, run_frame_case, test_case); };
    return {
        {"clock", When::always, run_clock_case},
        frame("bunny-0.1", When::always, {kBunny, 0.1, 64, 2 * kMiB, 1.0, 4.0, 12.0}),
        frame("bunny-2", When::always, {kBunny, 2.0, 64, 2 * kMiB, 4.0, 23.0, 25.0}),
        frame("1.1M-0.5", When::always,
              {kFineBunny, 0.5, 64, 4 * kMiB, 9.0, 28.0, 45.0, 120.0, 145e3, 200e3, 125e3}),
        frame("1.1M-2", When::always, {kFineBunny, 2.0, 128, 4 * kMiB, 25.0, 90.0, 125.0}),
        frame("4.3M-0.5", When::full_only,
              {kFineIgea, 0.5, 128, 8 * kMiB, 30.0, 80.0, 90.0, 250.0}),
        make_case("memory-4.3M", When::full_only, run_memory_case,
                  MemoryCase{kFineIgea, 0.1, 128, 4.0}),
        make_case("static-bunny", When::always, run_static_case,
                  StaticCase{kBunny, 0.6, 0.45, 0.3, 2.0}),
        make_case("static-4.3M", When::full_only, run_static_case,
                  StaticCase{kFineIgea, 0.2, 0.15, 0.3, 2.0}),
        make_case("static-growth", When::full_only, run_growth_case, GrowthCase{3.0}),
        frame("frame-tiny", When::named_only,
              {kTiny, 0.1, 64, kMiB, kNoGoal, kNoGoal, kNoGoal, kNoGoal}),
        make_case("static-tiny", When::named_only, run_static_case, StaticCase{kTiny}),
    };
}

} // namespace

Suite frame_suite()
{
    return {"frame", frame_cases};
}

} // namespace tactus::bench
