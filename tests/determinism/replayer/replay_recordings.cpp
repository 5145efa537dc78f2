// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// replay_recordings best|portable FILE...: replays recordings with these kernels and compares the
/// hashes of every frame; one line for each file. Exits 0 if all agree, 1 if a frame differs, 2 if
/// a file is refused, 3 for wrong usage.

#include "platform/recording/recording.hpp"
#include "platform/recording/replay.hpp"
#include "rt_core/kernels/kernels.hpp"

#include <algorithm>
#include <cstdio>
#include <string_view>

namespace
{

int replay_file(const char* path, const tactus::Kernels& kernels)
{
    const auto recording = tactus::Recording::read(path);
    if (!recording)
    {
        std::printf("%s\n", recording.error().text.c_str());
        return 2;
    }
    const auto replayed = tactus::replay(recording.value(), &kernels);
    if (!replayed)
    {
        std::printf("%s: %s\n", path, replayed.error().text.c_str());
        return 2;
    }
    const std::string line = tactus::replay_line(recording.value(), replayed.value());
    std::printf("%s: %s\n", path, line.c_str());
    return replayed.value().difference ? 1 : 0;
}

} // namespace

int main(int argc, char** argv)
{
    const std::string_view set = argc > 2 ? argv[1] : "";
    if (set != "best" && set != "portable")
    {
        std::printf("usage: replay_recordings best|portable FILE...\n");
        return 3;
    }
    const tactus::Kernels& kernels =
        set == "best" ? tactus::best_kernels() : tactus::portable_kernels();
    std::printf("this program: %s; kernels %s\n", tactus::this_build().c_str(), kernels.name);
    int worst = 0;
    for (int i = 2; i < argc; ++i)
    {
        worst = std::max(worst, replay_file(argv[i], kernels));
    }
    return worst;
}
