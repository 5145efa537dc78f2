// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/frame_encoder.hpp"
#include "platform/recording/recording_writer.hpp"
#include "rt_core/frame/frame.hpp"
#include "transport/chunk_loader.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace tactus::test
{

/// Recorder of the frames of one rig, in memory and on its thread.
class RigRecorder
{
public:
    explicit RigRecorder(const FrameSetup& setup) : writer_(to_recorded(setup)) {}

    /// Copies each piece that `chunk_loader` hands over from now on; the chunk loader must not be
    /// used after the recorder's end.
    void follow(ChunkLoader& chunk_loader);

    void add_name(const RecordedName& what, std::string_view name) { writer_.add_name(what, name); }
    void add(const FrameInput& input, const FrameOutput& output);
    /// Whole recording; nothing may be added afterwards.
    [[nodiscard]] std::vector<std::byte> finish();

private:
    /// Pieces of one model.
    class Line final : public PieceSink
    {
    public:
        Line(RecordingWriter& writer, std::uint32_t model) : writer_(writer), model_(model) {}
        void receive(ContentKey key, std::span<const std::byte> bytes) override
        {
            writer_.add_piece(model_, key, bytes);
        }

    private:
        RecordingWriter& writer_;
        std::uint32_t model_;
    };

    RecordingWriter writer_;
    FrameEncoder encoder_;
    std::vector<std::unique_ptr<Line>> lines_;
};

} // namespace tactus::test
