// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/frame_encoder.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>
#include <optional>
#include <string>

namespace tactus
{

class LastInputs;
struct FrameSetup;

} // namespace tactus

namespace tactus::hrtc
{

/// File with the last inputs of a run that failed and was not recorded.
struct KeptInputs
{
    std::string path;
    std::uint64_t frames{0};
};

/// Writes the inputs of the last frames as a recording, with the failed frame at the end. The
/// recording repeats the device motion but can't be replayed, since a frame's state depends on all
/// frames before. The file is hrtc-failed-PID.rec in the working directory, or in the folder for
/// temporary files if that fails. `failed` is none if the failure was between frames. Not on the
/// haptic thread; call it when no frame runs any more.
[[nodiscard]] Result<KeptInputs, Refusal> write_last_inputs(const LastInputs& inputs,
                                                            const std::optional<GivenFrame>& failed,
                                                            const FrameSetup& setup);

} // namespace tactus::hrtc
