// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/rig_recorder.hpp"

namespace tactus::test
{

void RigRecorder::follow(ChunkLoader& chunk_loader)
{
    for (std::uint32_t model = 0; model < chunk_loader.model_count(); ++model)
    {
        lines_.push_back(std::make_unique<Line>(writer_, model));
        chunk_loader.copy_pieces_to(lines_.back().get(), model);
    }
}

void RigRecorder::add(const FrameInput& input, const FrameOutput& output)
{
    writer_.add_frame(encoder_.encode(input, output));
}

std::vector<std::byte> RigRecorder::finish()
{
    writer_.finish(kNoFrame);
    return writer_.take_bytes();
}

} // namespace tactus::test
