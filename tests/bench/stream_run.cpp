// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/stream_run.hpp"

namespace tactus::bench
{

namespace
{

/// Reloads closer together belong to one burst.
constexpr std::uint64_t kBurstFrames = 500;

bool is_settled(AnswerKind kind)
{
    return kind == AnswerKind::exact || kind == AnswerKind::separated;
}

} // namespace

void StreamCounter::add(const FrameOutput& output)
{
    const AnswerKind kind = output.pairs[0].kind;
    const ToolOutput& tool = output.tools[0];
    figures_.open += is_settled(kind) ? 0U : 1U;
    figures_.exact += kind == AnswerKind::exact ? 1U : 0U;
    figures_.waiting += tool.halted || tool.data_limited ? 1U : 0U;
    figures_.hits += output.work.cache_hits;
    figures_.misses += output.work.cache_misses;
    if (figures_.taps < tour_.touches.size() && tour_.touches[figures_.taps] == figures_.frames)
    {
        ++figures_.taps;
        figures_.late_taps += is_settled(kind) && !tool.halted && !tool.data_limited ? 0U : 1U;
    }
    count_loads(output.queues.events);
    figures_.hash += output.models[0].state_hash * (2 * figures_.frames + 1);
    ++figures_.frames;
}

void StreamCounter::count_loads(std::span<const QueueEvent> events)
{
    bool reloads = false;
    for (const QueueEvent& event : events)
    {
        if (event.kind == QueueEventKind::arrival && event.key.kind == ContentKind::chunk)
        {
            ++figures_.loads;
            const bool is_new = seen_.insert(event.key.number).second;
            figures_.reloads += is_new ? 0U : 1U;
            reloads = reloads || !is_new;
        }
    }
    if (reloads)
    {
        figures_.reload_bursts += figures_.frames >= burst_ends_ ? 1U : 0U;
        burst_ends_ = figures_.frames + kBurstFrames;
    }
}

StreamFigures stream(const StreamRun& run)
{
    test::RigOptions options = run.rig;
    options.chunk_loader_steps_per_frame = 1;
    options.faults.delay_polls_min = run.latency_frames;
    options.faults.delay_polls_max = run.latency_frames;
    test::FrameRig rig(run.scene.model, options);
    StreamCounter counter(run.tour);
    for (const Vec3& goal_m : run.tour.goals_m)
    {
        counter.add(rig.step(goal_m, run.budgets));
    }
    StreamFigures figures = counter.figures();
    figures.bytes = rig.chunk_loader().counters().coded_bytes;
    return figures;
}

} // namespace tactus::bench
