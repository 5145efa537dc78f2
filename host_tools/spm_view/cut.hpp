// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"
#include "host_tools/encode/replay.hpp"
#include "host_tools/spm_view/known_model.hpp"
#include "transport/base/refusal.hpp"
#include "transport/front.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

// Any thread, but not the haptic one: calls allocate, and work on their arguments alone.
namespace tactus::view
{

/// Names the split records of a model: the same cut has the same. FNV-1a over the pages that have
/// any; pages are in the order of their chunks.
[[nodiscard]] std::uint64_t cut_id(std::span<const FrontPage> pages) noexcept;

/// What of a model the pages' split records need: base mesh and their chunks. Waits for what is
/// still to come (KnownModel::bring). Refused, in words, where the pages aren't the model's, or its
/// pieces aren't here or don't fit together; unless the pages are the `whole` of the front's cut, a
/// record may lack what it depends on. Must not outlive the model.
[[nodiscard]] Result<DecodedModel, Refusal>
decode_cut(KnownModel& model, std::span<const FrontPage> pages, bool whole = true);

/// Splits all records of the pages. Refused, in words, where the pages aren't the model's: a chunk
/// that it doesn't have, a record without those that it depends on.
[[nodiscard]] std::optional<Refusal> split_all(Replay& replay, const DecodedModel& model,
                                               std::span<const FrontPage> pages);

/// The pages with those of their split records that can be split without others: what there is to
/// show of a front that leaves page slots out (Front::slots_left_out). Takes the model as
/// decode_cut() makes it of pages that aren't the whole.
[[nodiscard]] std::vector<FrontPage> splittable_part(const DecodedModel& model,
                                                     std::span<const FrontPage> pages);

/// The faces of a controller, rebuilt from the model: the base mesh with the pages' records split.
/// Refused as split_all(). In time by the faces of the model and the split records.
///
/// Bytes, little-endian, faces in the order of their ids:
///
///     u32 vertices v, u32 faces f, f32 positions[3 v], u32 corners[3 f], f32 error_m[f],
///     u16 level[f], u16 0 if f is odd
///
/// Positions are in the model's frame, in metres. A face of the base mesh has level 0, one that a
/// record made that record's depth; `error_m` bounds how far it is from the source.
[[nodiscard]] Result<std::string, Refusal> cut_bytes(const DecodedModel& model,
                                                     std::span<const FrontPage> pages);

} // namespace tactus::view
