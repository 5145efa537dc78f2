// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/frame_replay.hpp"

#include "tests/bench/instruction_count.hpp"
#include "tests/bench/measuring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numeric>

namespace tactus::bench
{

namespace
{

/// Proxy speed limit relative to the slide's speed.
constexpr double kFollowTimes = 1.5;

} // namespace

FrameRun make_slide(const Scene& scene, double speed_diag_per_s, std::uint32_t splits,
                    std::size_t pool_bytes, std::uint32_t frames)
{
    FrameRun run{
        scene, slide_motion(scene.touch(), speed_diag_per_s, frames), kApproachFrames, {}, {}, 1};
    ToolSpec tool;
    tool.radius_m = kRadius_diag * scene.model.diagonal_m;
    tool.speed_max_m_per_s = kFollowTimes * speed_diag_per_s * scene.model.diagonal_m;
    run.rig.tools = {tool};
    run.rig.pool_bytes = pool_bytes;
    run.budgets.splits = splits;
    run.budgets.merges = splits;
    return run;
}

FrameReplay::FrameReplay(const FrameRun& run) : run_(run)
{
    sum_us_.fill(LeastTimes(run.counted()));
    stage_us_.fill(LeastTimes(run.counted()));
}

void FrameReplay::prepare(test::FrameRig& rig, CacheState caches)
{
    rig.deliver();
    if (caches != CacheState::warm)
    {
        evictor_.evict();
    }
    if (caches != CacheState::cold)
    {
        rig.frame().warm_caches();
    }
}

void FrameReplay::run(CacheState caches, std::uint32_t passes, std::size_t frames)
{
    for (std::uint32_t pass = 0; pass < passes; ++pass)
    {
        run_once(caches, frames);
    }
}

void FrameReplay::run_once(CacheState caches, std::size_t frames)
{
    test::FrameRig rig(std::vector(run_.models, &run_.scene.model), run_.rig);
    StageTimer timer;
    std::uint64_t allocations = 0;
    std::uint64_t bytes_before = 0;
    std::size_t next_edit = 0;
    for (std::size_t i = 0; i < std::min(run_.lead_in + frames, run_.goals_m.size()); ++i)
    {
        const bool is_counted = i >= run_.lead_in;
        const std::vector<Vec3> goals{run_.goals_m[i]};
        if (i == run_.lead_in)
        {
            bytes_before = rig.chunk_loader().counters().coded_bytes;
        }
        for (; next_edit < run_.edits.size() && run_.edits[next_edit].frame == i; ++next_edit)
        {
            const EditContent& edit = run_.edits[next_edit].edit;
            rig.edit({ModelId{0}, edit.revision, edit.removed, edit.added, edit.removed_m});
        }
        prepare(rig, is_counted ? caches : CacheState::warm);
        FrameOutput output;
        const std::uint64_t frame_allocations = allocations_of(
            [&]
            {
                timer.begin();
                output = is_counted ? counted_step(rig, goals, run_.budgets, timer.mark())
                                    : rig.step_without_delivery(goals, run_.budgets, timer.mark());
            });
        if (i == hashes_.size())
        {
            hashes_.push_back(output.models[0].state_hash);
            if (is_counted)
            {
                count(output);
                work_.coded_bytes = rig.chunk_loader().counters().coded_bytes - bytes_before;
            }
        }
        if (hashes_[i] != output.models[0].state_hash)
        {
            throw Failure(fmt::format("frame {}: a replay of the same goals gave state {:016x}, "
                                      "not {:016x}",
                                      i, output.models[0].state_hash, hashes_[i]));
        }
        if (!is_counted)
        {
            continue;
        }
        allocations += frame_allocations;
        const std::size_t place = i - run_.lead_in;
        sum_us_[index(caches)].keep(place, timer.sum_us() - timer.us(Stage::force));
        for (std::size_t stage = 0; caches == CacheState::warm && stage < kStages; ++stage)
        {
            stage_us_[stage].keep(place, timer.us(static_cast<Stage>(stage)));
        }
    }
    allocations_ = counted_if_available(allocations);
}

void FrameReplay::count(const FrameOutput& output)
{
    const AnswerKind kind = output.pairs[0].kind;
    const bool is_in_contact = output.tools[0].in_contact;
    splits_.push_back(output.work.splits);
    answers_.push_back(output.pairs[0]);
    ++work_.frames;
    work_.counters += output.work;
    for (const std::uint32_t times : output.scene.edits_refused)
    {
        work_.edits_refused += times;
    }
    work_.contacts += is_in_contact ? 1 : 0;
    work_.uncertified += is_in_contact && kind != AnswerKind::exact ? 1 : 0;
    work_.open += kind == AnswerKind::exact || kind == AnswerKind::separated ? 0 : 1;
    work_.model = output.models[0];
}

double FrameReplay::split_us() const
{
    const auto sum = [](const std::vector<double>& each)
    { return std::accumulate(each.begin(), each.end(), 0.0); };
    const double splits = sum(splits_);
    const double time_us =
        sum(stage_us(Stage::refine).least()) + sum(stage_us(Stage::refit).least());
    return splits > 0.0 ? time_us / splits : std::numeric_limits<double>::quiet_NaN();
}

std::uint64_t FrameReplay::hash() const
{
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < hashes_.size(); ++i)
    {
        sum += hashes_[i] * (2 * i + 1);
    }
    return sum;
}

} // namespace tactus::bench
