// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/last_inputs.hpp"
#include "rt_core/frame/frame.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace tactus::hrtc
{

/// What is left of a run that failed and was not recorded.
struct KeptInputs
{
    std::string path;
    std::uint64_t frames{0};
};

/// Writes what the last frames were given, the one that failed at the end, as a recording that
/// moves the hand again: hrtc-failed-PID.rec in the working directory or, where that can't be
/// written, in the one for temporary files. A frame's state rests on all frames before it, so only
/// a recording of the whole run replays it. Once no frame runs any more; not the haptic thread.
/// `failed`: none where it failed between frames.
[[nodiscard]] Result<KeptInputs, Refusal> write_last_inputs(const LastInputs& inputs,
                                                            const std::optional<GivenFrame>& failed,
                                                            const FrameSetup& setup);

} // namespace tactus::hrtc
