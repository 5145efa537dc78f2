// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"
#include "host_tools/spm_view/known_model.hpp"
#include "transport/front.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

// Any thread, but not the haptic one: calls allocate, and work on their arguments alone.
//
// Bytes, little-endian: u32 boxes n, f32 low and high[6 n], of the model's frame, in metres.
namespace tactus::view
{

/// Deepest level of a tree that is told: beyond it there are blocks alone.
inline constexpr std::uint32_t kTreeLevelsMax = 24;

/// The boxes of the controller's AB-Tree, so many levels of nodes below its root, and the blocks
/// that lie above: the tree depends on nothing but the faces, so it is built here of the same
/// pages. Refused as cut_bytes().
[[nodiscard]] Result<std::string, Refusal>
tree_box_bytes(const DecodedModel& model, std::span<const FrontPage> pages, std::uint32_t level);

/// The influence boxes of chunks, which are ascending: where what a controller has loaded, or
/// wishes for, is of use. Waits for index pages (KnownModel::bring). Refused where the chunks
/// aren't the model's.
[[nodiscard]] Result<std::string, Refusal> chunk_box_bytes(KnownModel& model,
                                                           std::span<const ChunkId> chunks);
/// The chunks of the pages.
[[nodiscard]] std::vector<ChunkId> chunks_of(std::span<const FrontPage> pages);

} // namespace tactus::view
