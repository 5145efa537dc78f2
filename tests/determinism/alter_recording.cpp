// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// alter_recording FROM TO FRAME: writes a sound recording with another goal in one frame. Exits 2
/// on failure.

#include "tests/shared/altered_recording.hpp"

#include <cstdio>
#include <fstream>
#include <string>

int main(int argc, char** argv)
{
    if (argc != 4)
    {
        std::printf("usage: alter_recording FROM TO FRAME\n");
        return 2;
    }
    const auto recording = tactus::Recording::read(argv[1]);
    if (!recording)
    {
        std::printf("%s\n", recording.error().text.c_str());
        return 2;
    }
    const std::vector<std::byte> bytes = tactus::test::alter_frame(
        recording.value(), std::stoull(argv[3]), tactus::test::change_goal);
    std::ofstream file(argv[2], std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    return file.flush() ? 0 : 2;
}
