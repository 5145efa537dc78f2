// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/rig_recorder.hpp"

namespace tactus::test
{

void RigRecorder::follow(Courier& courier)
{
    const auto model = static_cast<std::uint32_t>(lines_.size());
    lines_.push_back(std::make_unique<Line>(writer_, model));
    courier.copy_pieces_to(lines_.back().get());
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

} // namespace tactus::test
