// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include <chrono>
#include <cstdio>
#include <tactus/world.hpp>
#include <thread>

int main(int argc, char** argv)
{
    tactus::World world({.memory_mib = 8, .allow_no_rt = true});
    world.add(tactus::model_file(argc > 1 ? argv[1] : "torus.spm"),
              {.material = {.stiffness_n_per_m = 800, .static_friction = 0.4}});
    const tactus::Hand hand =
        world.add(tactus::sphere(0.002), tactus::device(argc > 2 ? argv[2] : "sim"));
    if (const auto started = world.start(); !started)
        return std::fprintf(stderr, "guarded: %s\n", started.error().text.c_str()), 2;
    for (int i = 0; i < 50 && world.is_running(); ++i)
    {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        const tactus::HandState felt = hand.state();
        std::printf("%6.3f N %s\n", felt.force_n[2], hand.why(felt).c_str());
    }
    return world.stop() ? 0 : 2;
}
