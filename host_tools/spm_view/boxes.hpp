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

// Any thread, except the haptic one: calls allocate, and work on their arguments alone.
//
// Bytes, little-endian: u32 boxes n, f32 low and high[6 n], of the model's frame, in metres.
namespace tactus::view
{

/// Deepest tree level in an answer: beyond it there are only blocks.
inline constexpr std::uint32_t kTreeLevelsMax = 24;

/// Boxes of the controller's AB-Tree, `level` levels of nodes below its root, and the blocks above.
/// The tree depends only on the faces, so it is built here from the same pages. Refused like
/// cut_bytes().
[[nodiscard]] Result<std::string, Refusal>
tree_box_bytes(const DecodedModel& model, std::span<const RefinementStatePage> pages,
               std::uint32_t level);

/// Influence boxes of chunks, which must ascend: the regions in which a controller's resident or
/// requested chunks are of use. Waits for index pages (KnownModel::bring). Refused if the chunks
/// are not the model's.
[[nodiscard]] Result<std::string, Refusal> chunk_box_bytes(KnownModel& model,
                                                           std::span<const ChunkId> chunks);
/// Chunks of the pages.
[[nodiscard]] std::vector<ChunkId> chunks_of(std::span<const RefinementStatePage> pages);

} // namespace tactus::view
