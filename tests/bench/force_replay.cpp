// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/force_replay.hpp"

#include "platform/machine/allocation_counter.hpp"
#include "tests/bench/heap_use.hpp"
#include "tests/bench/stage_timer.hpp"
#include "tests/bench/static_model.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <utility>

namespace tactus::bench
{

namespace
{

std::uint64_t hash_of(const std::vector<ToolOutput>& outputs)
{
    std::uint64_t hash = 0xCBF2'9CE4'8422'2325U;
    for (const ToolOutput& output : outputs)
    {
        for (const Vec3& vector : {output.force_n, output.proxy_m})
        {
            for (const double number : {vector.x(), vector.y(), vector.z()})
            {
                hash = (hash ^ std::bit_cast<std::uint64_t>(number)) * 0x0000'0100'0000'01B3U;
            }
        }
    }
    return hash;
}

std::unique_ptr<test::FrameRig> make_rig(const ForceRun& run)
{
    test::RigOptions options;
    options.tools = {run.tool};
    options.objects = {{ModelId{0}, run.material}};
    options.static_when_it_fits = true;
    auto rig = refined_rig(run.scene, options);
    rig->model().residence = Residence::complete;
    return rig;
}

/// One replay; outputs and planes in the order of the counted frames.
std::vector<ToolOutput> replay(const ForceRun& run, test::FrameRig& rig, ForceTrace& trace)
{
    std::vector<ToolOutput> outputs;
    std::uint64_t allocations = 0;
    StageTimer timer;
    std::array<ToolState, 1> tools;
    trace.planes.clear();
    for (std::size_t i = 0; i < run.goals_m.size(); ++i)
    {
        tools[0].position_m = run.goals_m[i];
        FrameOutput output;
        allocations += allocations_of(
            [&]
            {
                timer.begin();
                output = rig.frame().run(rig.input(tools, Budgets{}), timer.mark());
            });
        if (i >= run.lead_in)
        {
            outputs.push_back(output.tools[0]);
            trace.planes.push_back(static_cast<double>(output.work.planes_looked_at));
            trace.force_us.keep(i - run.lead_in, timer.us(Stage::force));
            trace.frame_us.keep(i - run.lead_in, timer.sum_us());
        }
    }
    if (allocation_counter::available())
    {
        trace.allocations = std::max(trace.allocations.value_or(0), allocations);
    }
    return outputs;
}

} // namespace

ForceTrace replay_forces(const ForceRun& run, std::uint32_t passes)
{
    ForceTrace trace;
    trace.force_us = LeastTimes(run.goals_m.size() - run.lead_in);
    trace.frame_us = trace.force_us;
    for (std::uint32_t pass = 0; pass < passes; ++pass)
    {
        const auto rig = make_rig(run);
        std::vector<ToolOutput> outputs = replay(run, *rig, trace);
        const std::uint64_t hash = hash_of(outputs);
        if (pass > 0 && hash != trace.hash)
        {
            throw Failure(run.scene.model.name + ": a replay of the same goals gave other forces");
        }
        trace.outputs = std::move(outputs);
        trace.hash = hash;
    }
    return trace;
}

} // namespace tactus::bench
