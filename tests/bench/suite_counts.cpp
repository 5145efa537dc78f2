// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Suite `counts`: work of frames on three fixed scenes without external meshes, as counts that are
/// the same on every machine; no times. Under callgrind also instructions, see counts.py.

#include "tests/bench/frame_replay.hpp"
#include "tests/bench/static_model.hpp"
#include "tests/bench/suites.hpp"

#include <filesystem>

namespace tactus::bench
{

namespace
{

constexpr SceneSource kLarger{"larger", nullptr, 0, 60'000};
constexpr std::uint32_t kFrames = 2'000;

/// Slide with a proxy; all chunks stream and arrive 10 ms late.
FrameRun slide(const Scene& scene)
{
    FrameRun run = make_slide(scene, 0.5, 64, kMiB, kFrames);
    run.rig.chunk_loader_steps_per_frame = 1;
    run.rig.faults.delay_polls_min = run.rig.faults.delay_polls_max = 10;
    return run;
}

/// Flight, approach, slide and retreat over a model that fits and is refined once.
FrameRun touch_static(const Scene& scene)
{
    constexpr std::size_t kFillFrames = 1'000;
    FrameRun run = make_slide(scene, 0.5, 64, static_pool_bytes(scene), 1);
    run.goals_m = touch_motion(scene.touch(), kCycleFrames);
    run.goals_m.insert(run.goals_m.begin(), kFillFrames, run.goals_m.front());
    run.lead_in = kFillFrames;
    run.rig.static_when_it_fits = true;
    return run;
}

struct CountCase
{
    SceneSource scene;
    FrameRun (*make)(const Scene& scene);
};

void run_count_case(const CaseContext& context, const CountCase& test_case)
{
    const Scene& scene = context.scenes.get(test_case.scene);
    const FrameRun run = test_case.make(scene);
    FrameReplay replay(run);
    replay.run(1);
    Row common = context.common_row(scene.model.name);
    common.frames = run.counted();
    common.hash = replay.hash();
    CaseRows rows(context.rows, common);
    // Includes the frames before the slide, which callgrind counts; all other figures are of the
    // counted ones.
    rows.add("frames in all", static_cast<double>(run.goals_m.size()), "");
    const WorkCounters& work = replay.work().counters;
    rows.add("splits", work.splits, "");
    rows.add("merges", work.merges, "");
    rows.add("nodes visited", work.nodes_visited, "");
    rows.add("triangles", work.triangles_tested, "");
    rows.add("refit visits", static_cast<double>(replay.work().refit_visits()), "");
    rows.add("bytes on the wire", static_cast<double>(replay.work().coded_bytes), "");
    rows.add("bytes of the file", static_cast<double>(std::filesystem::file_size(scene.model.path)),
             "");
}

std::vector<Case> counts_cases()
{
    const auto count = [](const char* name, const SceneSource& scene,
                          FrameRun (*make)(const Scene&)) {
        return make_case(name, When::always, run_count_case, CountCase{scene, make});
    };
    return {count("slide, 4 k faces", kTiny, slide), count("slide, 60 k faces", kLarger, slide),
            count("touch, static, 4 k faces", kTiny, touch_static)};
}

} // namespace

Suite counts_suite()
{
    return {"counts", counts_cases};
}

} // namespace tactus::bench
