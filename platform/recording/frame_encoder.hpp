// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/change_coding.hpp"
#include "platform/recording/device_coding.hpp"
#include "platform/recording/fixed_writer.hpp"
#include "platform/recording/output_hash.hpp"
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
inline constexpr std::size_t kDoorEventBytes = 23;
inline constexpr std::size_t kMaxDoorEvents = kMaxArrivalsPerFrame + kMaxLinkUpdatesPerFrame;
/// The largest frame: every tool, change, model and event there can be.
inline constexpr std::size_t kMaxCodedFrameBytes =
    4 + 1 + 8 + kMaxTools * kToolStateBytes + 1 + kMaxSceneChanges * kSceneChangeBytes +
    kBudgetsBytes + 4 + 2 + kMaxDoorEvents * kDoorEventBytes + kMaxModels * 8 +
    sizeof(OutputHashes);

/// A frame's flags: changes of the scene follow, or budgets, since they differ from the frame
/// before; no hashes follow, since the frame failed or only what it was given is kept.
inline constexpr std::uint8_t kHasChanges = 1;
inline constexpr std::uint8_t kHasBudgets = 2;
inline constexpr std::uint8_t kHasNoHashes = 4;

/// What a frame is given.
struct GivenFrame
{
    FrameInput input;
    DoorTake door;
    std::span<const DeviceRecord> devices; ///< One a tool, or none where there are none.
};

/// Codes frames one after the other. Budgets are written only when they differ from the frame
/// before. Allocates nothing, so the haptic thread may use it.
class FrameEncoder
{
public:
    /// Codes what one Frame::run() got, at most kMaxSceneChanges changes among it, and what it
    /// returned; valid until the next call. `devices`: one a tool, or none where there are none.
    [[nodiscard]] std::span<const std::byte>
    encode(const FrameInput& input, const FrameOutput& output,
           std::span<const DeviceRecord> devices = {}) noexcept;
    /// The same of what a run got alone, its budgets in any case.
    [[nodiscard]] std::span<const std::byte> encode_given(const GivenFrame& frame) noexcept;

private:
    [[nodiscard]] FixedWriter begin(const GivenFrame& frame, std::uint8_t flags) noexcept;
    [[nodiscard]] std::span<const std::byte> end(const FixedWriter& writer) noexcept;

    std::array<std::byte, kMaxCodedFrameBytes> bytes_{};
    std::array<std::byte, kBudgetsBytes> budgets_{};
    bool has_begun_{false};
};

} // namespace tactus
