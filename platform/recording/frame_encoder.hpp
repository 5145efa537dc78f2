// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

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
inline constexpr std::size_t kToolStateBytes = 37 + 72;
inline constexpr std::size_t kObjectPoseBytes = 124;
inline constexpr std::size_t kBudgetsBytes = 32;
inline constexpr std::size_t kDoorEventBytes = 22;
inline constexpr std::size_t kMaxDoorEvents = kMaxArrivalsPerFrame + kMaxLinkUpdatesPerFrame;
/// The largest frame: every tool, object, model and event there can be.
inline constexpr std::size_t kMaxCodedFrameBytes =
    4 + 1 + kMaxTools * kToolStateBytes + kMaxObjects * kObjectPoseBytes + kBudgetsBytes +
    kMaxModels * (4 + 2 + kMaxDoorEvents * kDoorEventBytes + 8) + sizeof(OutputHashes);

/// A frame's flags: poses or budgets follow, since they differ from the frame before.
inline constexpr std::uint8_t kHasPoses = 1;
inline constexpr std::uint8_t kHasBudgets = 2;
/// A tool's.
inline constexpr std::uint8_t kIsValid = 1;
inline constexpr std::uint8_t kHasRotation = 2;

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

} // namespace tactus
