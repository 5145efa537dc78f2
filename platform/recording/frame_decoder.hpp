// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/output_hash.hpp"
#include "rt_core/base/byte_io.hpp"
#include "rt_core/records/device_record.hpp"
#include "rt_core/records/door_event.hpp"
#include "rt_core/records/frame_input.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus
{

/// How many of each a recording has in every frame.
struct FrameShape
{
    std::size_t tools{0};
    std::size_t models{0};
};

/// One frame as it was recorded.
struct RecordedFrame
{
    std::int64_t now_ns{0};
    std::vector<ToolState> tools;
    std::vector<DeviceRecord> devices; ///< One a tool.
    std::vector<SceneChange> changes;
    Budgets budgets;
    std::uint32_t wish_room{0};
    std::vector<DoorEvent> events;           ///< That were taken from the door.
    bool has_hashes{true};                   ///< False: it failed, or only its input was kept.
    std::vector<std::uint64_t> state_hashes; ///< One a model, after the frame.
    OutputHashes output;

    [[nodiscard]] FrameInput input() const noexcept { return {tools, changes, budgets, now_ns}; }
};

/// Reads frames that a FrameEncoder coded, in the same order. One thread, not the haptic one: it
/// allocates.
class FrameDecoder
{
public:
    explicit FrameDecoder(const FrameShape& shape);

    /// Null when the next frame was read into frame(); otherwise what is wrong with it, in words
    /// that follow "frame N: ".
    [[nodiscard]] const char* decode(ByteReader& reader);
    [[nodiscard]] const RecordedFrame& frame() const noexcept { return frame_; }

private:
    [[nodiscard]] const char* decode_body(ByteReader& reader);
    [[nodiscard]] const char* decode_door(ByteReader& reader);
    [[nodiscard]] bool decode_tools(ByteReader& reader);
    [[nodiscard]] bool decode_changes(ByteReader& reader);

    RecordedFrame frame_;
    bool has_begun_{false};
};

} // namespace tactus
