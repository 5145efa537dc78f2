// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
//
// fade: the force of a steady push while the device's samples go bad, as bits that are the same on
// every processor. Then the refusal of a frame without memory.
#include <bit>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <tactus/rt_core/base/arena.hpp>
#include <tactus/rt_core/force/force_pipeline.hpp>
#include <tactus/rt_core/frame/frame.hpp>
#include <tactus/version.hpp>

using namespace tactus;

int main()
{
    ForcePipeline pipeline(pipeline_setup({}, {}, 1e-3, 1.0));
    for (int i = 0; i < 100; ++i)
    {
        ToolOutput output;
        output.in_contact = true;
        output.force_n = Vec3(0.3, 0.1, 1.0 + 0.01 * i);
        output.stiffness_n_per_m = 500.0;
        const ForceOff causes = i < 60 ? ForceOff::none : ForceOff::garbage;
        const ToolForce& force =
            pipeline.step({}, output, {}, {}, {.elapsed_s = 1e-3, .causes = causes});
        std::printf("%016llx\n", static_cast<unsigned long long>(
                                     std::bit_cast<std::uint64_t>(force.push.force_n.z())));
    }
    Arena none({});
    std::optional<Frame> frame;
    const auto started = Frame::start(frame, none, FrameSetup{});
    std::printf("%s: %s\n", TACTUS_VERSION_STRING,
                started ? "started" : refusal_text(started.error()));
    return 0;
}
