// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/hrtc/replay_file.hpp"

#include "host_tools/cli/command_line.hpp"
#include "platform/base/printable.hpp"
#include "platform/recording/replay.hpp"

#include <fmt/format.h>

namespace tactus::hrtc
{

int replay_file(const std::string& path, const Kernels* kernels, const Log& log)
{
    const auto recording = Recording::read(path);
    if (!recording)
    {
        log(recording.error().text);
        return kExitFailed;
    }
    const auto replayed = replay(recording.value(), kernels);
    if (!replayed)
    {
        log(path + ": " + replayed.error().text);
        return kExitFailed;
    }
    const std::string line = replay_line(recording.value(), replayed.value());
    if (replayed.value().difference)
    {
        log(path + ": " + line);
        return kExitCriterionNotMet;
    }
    fmt::print("{}: {}\n", printable(path), line);
    return kExitDone;
}

} // namespace tactus::hrtc
