// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/frame_encoder.hpp"
#include "platform/recording/recording_writer.hpp"
#include "rt_core/frame/frame.hpp"
#include "transport/courier.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::test
{

/// Records the frames of one rig, in memory and on its thread.
class RigRecorder final : private PieceSink
{
public:
    /// Takes a copy of each piece that `courier` hands over from now on; the courier must not be
    /// used any more once the recorder is gone.
    RigRecorder(const FrameSetup& setup, Courier& courier);

    void add(std::span<const ToolState> tools, std::span<const ObjectPose> poses,
             const Budgets& budgets, const FrameOutput& output);
    /// The whole recording; nothing may be added afterwards.
    [[nodiscard]] std::vector<std::byte> finish();

private:
    void receive(ContentKey key, std::span<const std::byte> bytes) override;

    RecordingWriter writer_;
    FrameEncoder encoder_;
};

} // namespace tactus::test
