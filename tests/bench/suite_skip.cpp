// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Suite `skip`: savings of each shortcut of a frame, disabled one at a time and together. Exact
/// answers must stay the same to the bit, or the case fails.

#include "tests/bench/frame_replay.hpp"
#include "tests/bench/instruction_count.hpp"
#include "tests/bench/suites.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace tactus::bench
{

namespace
{

/// Variant of a frame without a shortcut.
struct Without
{
    const char* name;
    void (*leave_out)(FrameRun& run);
    bool is_of_models{false}; ///< Also measured with several models.
};

void keep_splits(FrameRun& run)
{
    run.budgets.merges = 0;
    run.budgets.scanned = 0;
}

/// Radius in place of certificates, with all faces within it; nearly every answer on these scenes
/// is exact in it.
constexpr double kFixedRadius = 1.5;

constexpr std::array<Without, 14> kWithout{{
    {"all shortcuts", [](FrameRun&) {}, true},
    {"all objects near", [](FrameRun& run) { run.rig.variant.finds_neighbours = false; }},
    {"no rest of tools", [](FrameRun& run) { run.rig.variant.lets_tools_rest = false; }},
    {"no rest of frames", [](FrameRun& run) { run.rig.variant.lets_frames_rest = false; }},
    {"no rest out of reach", [](FrameRun& run) { run.rig.variant.lets_pairs_rest = false; }},
    {"no warm start", [](FrameRun& run) { run.rig.variant.starts_warm = false; }},
    {"no lasting certificates", [](FrameRun& run) { run.rig.variant.keeps_certificates = false; }},
    {"no certificates, fixed radius",
     [](FrameRun& run) { run.rig.variant.fixed_radius = kFixedRadius; }},
    {"refit of everything", [](FrameRun& run) { run.rig.variant.refits_changed_only = false; }},
    {"no coarsening", keep_splits},
    {"all models asked for", [](FrameRun& run) { run.rig.variant.asks_near_models_only = false; },
     true},
    {"a search every frame", [](FrameRun& run) { run.rig.variant.keeps_searches = false; }},
    {"no prefetch", [](FrameRun& run) { run.rig.variant.asks_ahead = false; }},
    {"none of them",
     [](FrameRun& run)
     {
         run.rig.variant = {.finds_neighbours = false,
                            .lets_tools_rest = false,
                            .lets_frames_rest = false,
                            .lets_pairs_rest = false,
                            .starts_warm = false,
                            .keeps_certificates = false,
                            .refits_changed_only = false,
                            .asks_near_models_only = false,
                            .keeps_searches = false,
                            .asks_ahead = false,
                            .fixed_radius = kFixedRadius};
         keep_splits(run);
     }},
}};

struct SkipCase
{
    SceneSource scene;
    double pool_mib;
    std::uint32_t models; ///< Models with one object each; the tool touches the first.
    Without without;
};

/// Distance from the touched object to the next, greater than any distance of the tool from the
/// first.
constexpr double kModelsApart_diag = 4.0;

std::string name_of(const SkipCase& test_case)
{
    return test_case.models == 1
               ? test_case.scene.name
               : fmt::format("{}, {} models", test_case.scene.name, test_case.models);
}

/// Half flight, half touch, since a shortcut may be for either.
FrameRun make_run(const CaseContext& context, const SkipCase& test_case, const Scene& scene)
{
    constexpr std::uint32_t kSplits = 64;
    constexpr double kSpeed_diag_per_s = 2.0; // Speed of the flight.
    const std::uint32_t frames = context.options.frames_or(2 * kCycleFrames, kCycleFrames);
    FrameRun run = make_slide(scene, kSpeed_diag_per_s, kSplits,
                              static_cast<std::size_t>(test_case.pool_mib * 0x1p20), 1);
    run.goals_m = touch_motion(scene.touch(), frames);
    run.lead_in = 0;
    run.rig.tools[0].query_only = true; // The path does not depend on known data.
    run.rig.chunk_loader_steps_per_frame = 1;
    run.rig.faults.delay_polls_min = run.rig.faults.delay_polls_max = 10;
    run.models = test_case.models;
    for (std::uint32_t i = 0; i < run.models; ++i)
    {
        run.rig.objects.push_back({ModelId{i}});
        run.rig.poses.emplace_back();
        run.rig.poses[i].translation_m.x() = kModelsApart_diag * scene.model.diagonal_m * i;
    }
    return run;
}

bool is_exact(const PairOutput& pair)
{
    return pair.kind == AnswerKind::exact;
}

/// Compares the answers; a failure if one that is exact both times differs, or if too few are
/// exact.
void compare(const std::vector<PairOutput>& usual, const std::vector<PairOutput>& other)
{
    std::size_t exact = 0;
    std::size_t both_exact = 0;
    for (std::size_t i = 0; i < usual.size(); ++i)
    {
        const PairOutput& a = usual[i];
        const PairOutput& b = other[i];
        exact += is_exact(a) ? 1U : 0U;
        both_exact += is_exact(a) && is_exact(b) ? 1U : 0U;
        if (is_exact(a) && is_exact(b) &&
            (a.lower_m != b.lower_m || a.upper_m != b.upper_m || a.nearest_face != b.nearest_face))
        {
            throw Failure(
                fmt::format("frame {}: exact distances of {} and {} m", i, a.upper_m, b.upper_m));
        }
    }
    if (both_exact == 0 || 10 * both_exact < 9 * exact)
    {
        throw Failure(
            fmt::format("of {} exact answers only {} are exact without it", exact, both_exact));
    }
}

void run_skip_case(const CaseContext& context, const SkipCase& test_case)
{
    const Scene& scene = context.scenes.get(test_case.scene);
    const PinnedCore pinned(context.options.core);
    const FrameRun usual = make_run(context, test_case, scene);
    FrameRun run = usual;
    test_case.without.leave_out(run);
    FrameReplay replay(run);
    replay.run(context.options.passes_or(3, 2));
    Row common = context.common_row(scene.model.name);
    common.test_case = test_case.models == 1 ? scene.model.name : name_of(test_case);
    common.setting = test_case.without.name;
    common.frames = run.counted();
    common.hash = replay.hash();
    CaseRows rows(context.rows, common);
    const Spread spread = spread_of(replay.sum_us(CacheState::warm).least());
    rows.add("p50", spread.p50, "us");
    rows.add("p99", spread.p99, "us");
    const Spread loading = spread_of(replay.stage_us(Stage::load).least());
    rows.add("loading p99", loading.p99, "us");
    const FrameWork& work = replay.work();
    rows.add("splits", work.per_frame(work.counters.splits), "/frame");
    rows.add("nodes", work.per_frame(work.counters.nodes_visited), "/frame");
    rows.add("open", 100.0 * work.per_frame(work.open), "%");
    rows.add("refit visits", work.per_frame(work.refit_visits()), "/frame");
    rows.add("exact frames", static_cast<double>(std::ranges::count_if(replay.answers(), is_exact)),
             "");
    if (context.options.count)
    {
        return; // The comparison's frames must not be counted.
    }
    const auto counted = count_instructions(context);
    if (counted)
    {
        rows.add("instructions", static_cast<double>(*counted) / static_cast<double>(run.counted()),
                 "/frame");
    }
    FrameReplay with_all(usual);
    with_all.run(1);
    compare(with_all.answers(), replay.answers());
}

std::vector<Case> skip_cases()
{
    std::vector<Case> cases;
    const auto add = [&](When when, const SkipCase& test_case)
    {
        cases.push_back(make_case(fmt::format("{}, {}", name_of(test_case), test_case.without.name),
                                  when, run_skip_case, test_case));
    };
    const auto add_all = [&](When when, const SceneSource& scene, double pool_mib)
    {
        for (const Without& without : kWithout)
        {
            add(when, {scene, pool_mib, 1, without});
            if (without.is_of_models)
            {
                add(when, {scene, 2.0 * pool_mib, 8, without});
            }
        }
    };
    add_all(When::always, kBunny, 4.0);
    add_all(When::full_only, kFineBunny, 16.0);
    add_all(When::named_only, kTiny, 2.0);
    return cases;
}

} // namespace

Suite skip_suite()
{
    return {"skip", skip_cases};
}

} // namespace tactus::bench
