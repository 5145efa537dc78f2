// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"
#include "host_tools/encode/replay.hpp"
#include "host_tools/spm_view/known_model.hpp"
#include "transport/base/refusal.hpp"
#include "transport/edit_state.hpp"
#include "transport/refinement_state.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

// Any thread except the haptic one: calls allocate. Results depend on the arguments alone.
namespace tactus::view
{

/// Hash (FNV-1a) of a cut: equal split records give equal hashes. `pages` must ascend; those
/// without split records do not count.
[[nodiscard]] std::uint64_t cut_id(std::span<const RefinementStatePage> pages) noexcept;

/// Decodes the base mesh and the chunks with split records. Waits for missing pieces
/// (KnownModel::bring). Refused if the model lacks a page's chunk or record, or if pieces are
/// missing or inconsistent. If `whole` is false, `pages` are only a part of the cut, in which
/// records may lack their dependencies. The result must not outlive `model`.
[[nodiscard]] Result<DecodedModel, Refusal>
decode_cut(KnownModel& model, std::span<const RefinementStatePage> pages, bool whole = true);

/// Splits all records of the pages. Refused if the model lacks a chunk, or if a record's
/// dependencies are not in the pages.
[[nodiscard]] std::optional<Refusal> split_all(Replay& replay, const DecodedModel& model,
                                               std::span<const RefinementStatePage> pages);

/// The pages with only those split records whose dependencies are in the pages too: the part of an
/// incomplete refinement state (RefinementState::slots_left_out) that can be shown. `model` is from
/// decode_cut() with `whole` false.
[[nodiscard]] std::vector<RefinementStatePage>
splittable_part(const DecodedModel& model, std::span<const RefinementStatePage> pages);

/// Faces of a controller: the base mesh with the records of `pages` split. Refused like
/// split_all(). The cost grows with the model's faces and with the split records.
///
/// Form of the result, little-endian, with faces ascending by id:
///
///     u32 vertices v, u32 faces f, f32 positions[3 v], u32 corners[3 f], f32 error_m[f],
///     u16 level[f], u16 0 if f is odd
///
/// Faces that `edits` removed are missing if they are at full resolution; coarse faces that stand
/// for removed ones are still there. The faces that edits added follow the others, with error and
/// level 0. `edits` may be null.
///
/// Positions are in metres in the model's frame. `level` is the depth of the record that made the
/// face, 0 in the base mesh; `error_m` bounds the face's distance from the source.
[[nodiscard]] Result<std::string, Refusal> cut_bytes(const DecodedModel& model,
                                                     std::span<const RefinementStatePage> pages,
                                                     const EditState* edits = nullptr);

/// Maximum level of tree_box_bytes(): the nodes of deeper levels are all blocks.
inline constexpr std::uint32_t kTreeLevelsMax = 24;

/// Boxes of the controller's AB-Tree: nodes at depth `level` (0: root), and blocks at smaller
/// depths. The tree depends on the faces only, so it is rebuilt from the same pages. Refused like
/// cut_bytes(). Form, little-endian: u32 number of boxes n, then n times f32 low[3], high[3], in
/// metres in the model's frame.
[[nodiscard]] Result<std::string, Refusal>
tree_box_bytes(const DecodedModel& model, std::span<const RefinementStatePage> pages,
               std::uint32_t level);

/// Influence boxes of these chunks, in the form of tree_box_bytes(). A tool's sphere
/// outside of a box needs no record of its chunk. The chunk ids must ascend. Waits for missing
/// index pages (KnownModel::bring). Refused if the model lacks a chunk.
[[nodiscard]] Result<std::string, Refusal> chunk_box_bytes(KnownModel& model,
                                                           std::span<const ChunkId> chunks);
/// Chunk numbers of the pages.
[[nodiscard]] std::vector<ChunkId> chunks_of(std::span<const RefinementStatePage> pages);

} // namespace tactus::view
