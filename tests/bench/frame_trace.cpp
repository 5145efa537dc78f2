// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/bench/frame_trace.hpp"

namespace tactus::bench
{

FrameTrace trace_frames(const FrameRun& run)
{
    FrameTrace trace;
    test::FrameRig rig(run.scene.model, run.rig);
    std::uint64_t before = 0;
    for (std::size_t i = 0; i < run.goals_m.size(); ++i)
    {
        if (i == run.lead_in)
        {
            before = rig.courier().counters().coded_bytes;
        }
        const FrameOutput output = rig.step({run.goals_m[i]}, run.budgets);
        if (i >= run.lead_in)
        {
            trace.pairs.push_back(output.pairs[0]);
            trace.work += output.work;
        }
        trace.model = output.models[0];
    }
    trace.coded_bytes = rig.courier().counters().coded_bytes - before;
    return trace;
}

} // namespace tactus::bench
