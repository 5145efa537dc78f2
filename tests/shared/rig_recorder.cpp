// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/rig_recorder.hpp"

namespace tactus::test
{

RigRecorder::RigRecorder(const FrameSetup& setup, Courier& courier) : writer_(to_recorded(setup))
{
    courier.copy_pieces_to(this);
}

void RigRecorder::add(std::span<const ToolState> tools, std::span<const ObjectPose> poses,
                      const Budgets& budgets, const FrameOutput& output)
{
    writer_.add_frame(encoder_.encode(tools, poses, budgets, output));
}

std::vector<std::byte> RigRecorder::finish()
{
    writer_.finish(kNoFrame);
    return writer_.take_bytes();
}

void RigRecorder::receive(ContentKey key, std::span<const std::byte> bytes)
{
    writer_.add_piece(0, key, bytes);
}

} // namespace tactus::test
