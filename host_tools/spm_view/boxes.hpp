// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"
#include "host_tools/spm_view/known_model.hpp"
#include "transport/refinement_state.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

// Any thread except the haptic one: calls allocate. Results depend on the arguments alone.
//
// Form of the results, little-endian: u32 number of boxes n, then n times f32 low[3], high[3], in
// metres in the model's frame.
namespace tactus::view
{

/// Maximum level of tree_box_bytes(): the nodes of deeper levels are all blocks.
inline constexpr std::uint32_t kTreeLevelsMax = 24;

/// Boxes of the controller's AB-Tree: nodes at depth `level` (0: root), and blocks at smaller
/// depths. The tree depends on the faces only, so it is rebuilt from the same pages. Refused like
/// cut_bytes().
[[nodiscard]] Result<std::string, Refusal>
tree_box_bytes(const DecodedModel& model, std::span<const RefinementStatePage> pages,
               std::uint32_t level);

/// Influence boxes of these chunks, as the page reads boxes (tree_box_bytes()). A tool's sphere
/// outside of a box needs no record of its chunk. The chunk ids must ascend. Waits for missing
/// index pages (KnownModel::bring). Refused if the model lacks a chunk.
[[nodiscard]] Result<std::string, Refusal> chunk_box_bytes(KnownModel& model,
                                                           std::span<const ChunkId> chunks);
/// Chunk numbers of the pages.
[[nodiscard]] std::vector<ChunkId> chunks_of(std::span<const RefinementStatePage> pages);

} // namespace tactus::view
