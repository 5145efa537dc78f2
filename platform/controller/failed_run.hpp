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

/// Inputs kept of a run that failed and was not recorded.
struct KeptInputs
{
    std::string path;
    std::uint64_t frames{0};
};

/// Writes the inputs of the last frames, with the failed one at the end, as a recording that
/// repeats the device motion. The file is hrtc-failed-PID.rec in the working directory, or in the
/// folder for temporary files if that fails. A frame's state depends on all frames before, so only
/// a recording of the whole run replays it. `failed` is none if the failure was between frames. Not
/// the haptic thread; call it when no frame runs any more.
[[nodiscard]] Result<KeptInputs, Refusal> write_last_inputs(const LastInputs& inputs,
                                                            const std::optional<GivenFrame>& failed,
                                                            const FrameSetup& setup);

} // namespace tactus::hrtc
