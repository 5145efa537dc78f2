// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/fixed_writer.hpp"
#include "platform/recording/recording_format.hpp"
#include "platform/recording/setup_coding.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/frame_input.hpp"
#include "rt_core/records/frame_output.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus
{

/// Sizes of the coded parts of a frame, in bytes; docs/recording.md lists the fields.
inline constexpr std::size_t kBudgetsBytes = 40;
inline constexpr std::size_t kQueueEventBytes = 23;
/// Sizes of an edit without its faces, and of an added face.
inline constexpr std::size_t kEditHeadBytes = 36;
inline constexpr std::size_t kAddedFaceBytes = 44;
inline constexpr std::size_t kMaxEditBytes =
    kEditHeadBytes + kMaxEditFaces * (sizeof(FaceId) + kAddedFaceBytes);
inline constexpr std::size_t kMaxQueueEvents = kMaxArrivalsPerFrame + kMaxLinkUpdatesPerFrame;
/// Size of the largest frame: all tools, changes, edits, models and events.
inline constexpr std::size_t kMaxCodedFrameBytes =
    4 + 1 + 8 + kMaxTools * kToolStateBytes + 1 + kMaxSceneChanges * kSceneChangeBytes + 1 +
    kMaxEditsPerFrame * kMaxEditBytes + kBudgetsBytes + 4 + 2 + kMaxQueueEvents * kQueueEventBytes +
    kMaxModels * 8 + sizeof(OutputHashes);

/// Flags of a frame, in this order: scene changes follow; budgets follow, since they differ from
/// those of the frame before; no hashes follow, since the frame failed or only its input is kept;
/// edits follow the changes.
inline constexpr std::uint8_t kHasChanges = 1;
inline constexpr std::uint8_t kHasBudgets = 2;
inline constexpr std::uint8_t kHasNoHashes = 4;
inline constexpr std::uint8_t kHasEdits = 8;

/// Input of a frame, including the events that it takes from the queues.
struct GivenFrame
{
    FrameInput input;
    QueueTake queues;
    std::span<const DeviceRecord> devices; ///< Records, one a tool, or empty without devices.
};

/// Encodes frames in order. Budgets are written only if they differ from the frame before.
/// Allocates nothing, so the haptic thread may use it.
class FrameEncoder
{
public:
    /// Encodes input, with up to kMaxSceneChanges changes and kMaxEditsPerFrame edits (asserted),
    /// and output of one Frame::run(). The result is valid until the next call. `devices`: one
    /// record a tool, or empty without devices.
    [[nodiscard]] std::span<const std::byte>
    encode(const FrameInput& input, const FrameOutput& output,
           std::span<const DeviceRecord> devices = {}) noexcept;
    /// Encodes the input alone, always with its budgets.
    [[nodiscard]] std::span<const std::byte> encode_given(const GivenFrame& frame) noexcept;

private:
    [[nodiscard]] FixedWriter begin(const GivenFrame& frame, std::uint8_t flags) noexcept;
    [[nodiscard]] std::span<const std::byte> end(const FixedWriter& writer) noexcept;

    std::array<std::byte, kMaxCodedFrameBytes> bytes_{};
    std::array<std::byte, kBudgetsBytes> budgets_{};
    bool has_begun_{false};
};

} // namespace tactus
