// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/output_hash.hpp"
#include "rt_core/base/byte_io.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/door_event.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus
{

/// Sizes of the coded parts of a frame, in bytes; docs/recording.md lists the fields.
inline constexpr std::size_t kToolStateBytes = 37;
inline constexpr std::size_t kObjectPoseBytes = 124;
inline constexpr std::size_t kBudgetsBytes = 32;
inline constexpr std::size_t kDoorEventBytes = 22;
inline constexpr std::size_t kMaxDoorEvents = kMaxArrivalsPerFrame + kMaxLinkUpdatesPerFrame;
/// The largest frame: every tool, object, model and event there can be.
inline constexpr std::size_t kMaxCodedFrameBytes =
    4 + 1 + kMaxTools * kToolStateBytes + kMaxObjects * kObjectPoseBytes + kBudgetsBytes +
    kMaxModels * (4 + 2 + kMaxDoorEvents * kDoorEventBytes + 8) + sizeof(OutputHashes);

/// Codes frames one after the other. Poses and budgets are written only when they differ from the
/// frame before. Allocates nothing, so the haptic thread may use it.
class FrameEncoder
{
public:
    /// Codes the arguments of one Frame::run() and what it returned; valid until the next call.
    [[nodiscard]] std::span<const std::byte> encode(std::span<const ToolState> tools,
                                                    std::span<const ObjectPose> poses,
                                                    const Budgets& budgets,
                                                    const FrameOutput& output) noexcept;

private:
    std::array<std::byte, kMaxCodedFrameBytes> bytes_{};
    std::array<std::byte, kMaxObjects * kObjectPoseBytes> poses_{};
    std::array<std::byte, kBudgetsBytes> budgets_{};
    bool has_begun_{false};
};

/// How many of each a recording has in every frame.
struct FrameShape
{
    std::size_t tools{0};
    std::size_t objects{0};
    std::size_t models{0};
};

/// One frame as it was recorded.
struct RecordedFrame
{
    struct Door
    {
        std::uint32_t wish_room{0};
        std::vector<DoorEvent> events;
    };

    std::vector<ToolState> tools;
    std::vector<ObjectPose> poses;
    Budgets budgets;
    std::vector<Door> doors;                 ///< One a model.
    std::vector<std::uint64_t> state_hashes; ///< One a model, after the frame.
    OutputHashes output;
};

/// Reads frames that a FrameEncoder coded, in the same order.
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
    [[nodiscard]] const char* decode_door(ByteReader& reader, RecordedFrame::Door& door);
    [[nodiscard]] bool decode_tools(ByteReader& reader);
    [[nodiscard]] bool decode_poses(ByteReader& reader);

    RecordedFrame frame_;
    bool has_begun_{false};
};

} // namespace tactus
