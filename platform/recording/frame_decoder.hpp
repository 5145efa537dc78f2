// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/recording_format.hpp"
#include "rt_core/base/byte_io.hpp"
#include "rt_core/records/device_record.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/queue_event.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus
{

/// Numbers of tools and models in every frame of a recording.
struct FrameShape
{
    std::size_t tools{0};
    std::size_t models{0};
};

/// Edits of one frame, with their faces.
class RecordedEdits
{
public:
    RecordedEdits() = default;
    RecordedEdits(const RecordedEdits& other);
    RecordedEdits(RecordedEdits&&) = default;
    RecordedEdits& operator=(const RecordedEdits& other);
    RecordedEdits& operator=(RecordedEdits&&) = default;
    ~RecordedEdits() = default;

    /// Appends an edit and copies its faces.
    void add(const SurfaceEdit& edit);
    void clear() noexcept;
    /// Edits in order; valid until a change, a copy or the end of this object.
    [[nodiscard]] std::span<const SurfaceEdit> view() const noexcept { return edits_; }

private:
    struct Faces
    {
        std::vector<FaceId> removed;
        std::vector<AddedFace> added;
    };
    std::vector<SurfaceEdit> edits_;
    std::vector<Faces> faces_; ///< Faces of `edits_`, whose views stay valid when this grows.
};

/// Inputs of one frame, and the hashes of its results.
struct RecordedFrame
{
    std::int64_t now_ns{0};
    std::vector<ToolState> tools;
    std::vector<DeviceRecord> devices; ///< Records, one a tool.
    std::vector<SceneChange> changes;
    RecordedEdits edits;
    Budgets budgets;
    std::uint32_t request_room{0};
    std::vector<QueueEvent> events; ///< Events that the frame took from the queues.
    bool has_hashes{true};          ///< False if the frame failed, or only its input was kept.
    std::vector<std::uint64_t> state_hashes; ///< State hash of each model after the frame.
    OutputHashes output;

    [[nodiscard]] FrameInput input() const noexcept
    {
        return {tools, changes, budgets, now_ns, edits.view()};
    }
};

/// Reads the frames of a FrameEncoder in the same order. One thread, not the haptic one: it
/// allocates.
class FrameDecoder
{
public:
    explicit FrameDecoder(const FrameShape& shape);

    /// Reads the next frame into frame(). Returns null, or the fault in words that follow "frame
    /// N".
    [[nodiscard]] const char* decode(ByteReader& reader);
    [[nodiscard]] const RecordedFrame& frame() const noexcept { return frame_; }

private:
    [[nodiscard]] const char* decode_body(ByteReader& reader);
    [[nodiscard]] const char* decode_queue(ByteReader& reader);
    [[nodiscard]] bool decode_tools(ByteReader& reader);
    [[nodiscard]] bool decode_changes(ByteReader& reader);
    [[nodiscard]] const char* decode_edits(ByteReader& reader);

    RecordedFrame frame_;
    bool has_begun_{false};
};

} // namespace tactus
