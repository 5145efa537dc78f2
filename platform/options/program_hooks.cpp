// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/options/program_hooks.hpp"

#include "platform/program/progress.hpp"
#include "platform/program/stop_signals.hpp"

#include <memory>

namespace tactus::hrtc
{

RunHooks program_hooks()
{
    return {.is_stopped = is_stop_requested,
            .begin_progress = [](const std::string& what) -> FramesDone
            {
                auto progress = std::make_shared<Progress>("hrtc", what, "frames");
                return [progress](std::uint64_t done, std::uint64_t all)
                { progress->update(done, all); };
            },
            .notifies_manager = true};
}

} // namespace tactus::hrtc
