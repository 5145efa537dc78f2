// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include <cstdio>
#include <tactus/world.hpp>

int main(int argc, char** argv)
{
    tactus::World world;
    world.add(tactus::model_file(argc > 1 ? argv[1] : "torus.spm"));
    const tactus::Hand hand = world.add(tactus::sphere(0.002));
    auto felt = hand.step({{0.05, 0.0, 0.0315}});
    for (int i = 1; i <= 1000 && felt; ++i) // Half a millimetre into the surface in 0.5 s.
        felt = hand.step({{0.05, 0.0, i < 500 ? 0.0315 - 2e-5 * i : 0.0215}});
    if (!felt)
        return std::fprintf(stderr, "hello: %s\n", felt.error().text.c_str()), 2;
    const tactus::HandState& state = felt.value();
    std::printf("force %.3f N, proxy at %.5f m\n", state.force_n[2], state.proxy_m[2]);
}
