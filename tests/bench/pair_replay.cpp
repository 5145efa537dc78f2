// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/pair_replay.hpp"

#include "tests/bench/stage_timer.hpp"
#include "tests/stability/whole_model.hpp"

#include <algorithm>
#include <bit>
#include <span>

namespace tactus::bench
{

namespace
{

/// Frames at the first place before the measurement, in which a local model is loaded and refined.
constexpr std::uint32_t kLeadIn = 500;

test::RigOptions options_of(const PairRun& run)
{
    test::RigOptions options;
    options.pool_bytes = run.pool_bytes;
    options.static_when_it_fits = run.is_static;
    ToolSpec tool;
    tool.radius_m = run.radius_m;
    tool.speed_max_m_per_s = run.speed_m_per_s;
    tool.core = MeshCore{ModelId{1}};
    tool.query_only = true;
    tool.wants_pairs = true;
    options.tools = {tool};
    return options;
}

std::uint64_t bits_of(const FrameOutput& output)
{
    const PairOutput& pair = output.pairs[0];
    return std::bit_cast<std::uint64_t>(pair.lower_m) +
           3 * std::bit_cast<std::uint64_t>(pair.upper_m) + 5 * pair.mesh->meeting.size() +
           7 * output.models[0].state_hash + 11 * output.models[1].state_hash;
}

void keep(const StageTimer& timer, std::size_t frame, PairFrames& frames)
{
    double sum_us = 0.0;
    for (const Stage stage : {Stage::load, Stage::refine, Stage::refit, Stage::query})
    {
        frames.stage_us[static_cast<std::size_t>(stage)].keep(frame, timer.us(stage));
        sum_us += timer.us(stage);
    }
    frames.sum_us.keep(frame, sum_us);
}

/// Runs once; returns the hash.
std::uint64_t replay_once(const PairRun& run, PairFrames& frames)
{
    test::FrameRig rig({&run.object.model, &run.tool.model}, options_of(run));
    if (run.is_static)
    {
        test::refine_fully(run.object.model.name, [&](const Budgets& budgets)
                           { return rig.step(std::span(run.places).first(1), budgets); });
    }
    for (std::uint32_t i = 0; i < kLeadIn; ++i)
    {
        rig.step(std::span(run.places).first(1), {});
    }
    const bool is_first = frames.answers.empty();
    StageTimer timer;
    std::uint64_t hash = 0;
    for (std::size_t i = 0; i < run.places.size(); ++i)
    {
        rig.deliver();
        const FrameInput input = rig.input(std::span(run.places).subspan(i, 1), {});
        timer.begin();
        const FrameOutput output = rig.frame().run(input, timer.mark());
        keep(timer, i, frames);
        hash += bits_of(output) * (2 * i + 1);
        if (is_first)
        {
            frames.answers.push_back(output.pairs[0]);
            frames.work += output.work;
            frames.meeting_pairs += output.pairs[0].mesh->meeting.size();
            frames.active_faces = std::max(frames.active_faces, rig.model().forest.active_faces());
        }
    }
    return hash;
}

} // namespace

PairFrames replay_pair(const PairRun& run, std::uint32_t passes)
{
    PairFrames frames;
    frames.stage_us.fill(LeastTimes(run.places.size()));
    frames.sum_us = LeastTimes(run.places.size());
    for (std::uint32_t pass = 0; pass < passes; ++pass)
    {
        const std::uint64_t hash = replay_once(run, frames);
        if (pass > 0 && hash != frames.hash)
        {
            throw Failure(run.object.model.name + ": replays gave other answers");
        }
        frames.hash = hash;
    }
    return frames;
}

} // namespace tactus::bench
