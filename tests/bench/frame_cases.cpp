// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Whole frames: a tool slides over a model that streams into small pools.

#include "tests/bench/cases.hpp"
#include "tests/bench/frame_replay.hpp"
#include "tests/bench/instruction_count.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/timed_queries.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

namespace tactus::bench
{

namespace
{

constexpr double kSplitGoal_us = 0.25;
constexpr double kPeerTolerance_diag = 2e-6;
/// Share of the slide that is measured cold, at its start: eviction takes 5 ms a frame.
constexpr std::size_t kColdShare = 4;

CaseRows rows_of(const CaseContext& context, const FrameRun& run, std::uint64_t hash)
{
    Row common = context.common_row(run.scene.model.name);
    common.frames = run.counted();
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

} // namespace

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
    CaseRows rows = rows_of(context, run, replay.hash());
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
            CaseRows rows = rows_of(context, run, replay.hash());
            rows.add("pools", is_enough ? mib : enough_mib, "MiB", test_case.pool_mib);
            rows.add("in contact", 100.0 * work.per_frame(work.contacts), "%");
            rows.add("uncertified contacts", static_cast<double>(work.uncertified), "frames");
            rows.add("pages used at most", work.model.pages.used_max, "");
            rows.add("faces used at most", work.model.faces.used_max, "");
            break;
        }
    }
}

} // namespace tactus::bench
