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

// Any thread, except the haptic one: calls allocate, and work on their arguments alone.
namespace tactus::view
{

/// Identifier of a cut, i.e. of the split records of a model: equal cuts have equal ones. FNV-1a
/// over the pages with split records, in the order of their chunks.
[[nodiscard]] std::uint64_t cut_id(std::span<const RefinementStatePage> pages) noexcept;

/// Parts of a model that the pages' split records need: base mesh and their chunks. Waits for
/// missing pieces (KnownModel::bring). Refused with the reason if the pages are not the model's, or
/// its pieces are missing or inconsistent. If `whole` is false, the pages are only a part of the
/// cut, and records may lack their dependencies. Must not outlive the model.
[[nodiscard]] Result<DecodedModel, Refusal>
decode_cut(KnownModel& model, std::span<const RefinementStatePage> pages, bool whole = true);

/// Splits all records of the pages. Refused with the reason if the pages are not the model's: a
/// chunk that it lacks, or a record without its dependencies.
[[nodiscard]] std::optional<Refusal> split_all(Replay& replay, const DecodedModel& model,
                                               std::span<const RefinementStatePage> pages);

/// The pages with those of their split records that can be split without others, which can be shown
/// of a refinement state with omitted page slots (RefinementState::slots_left_out). `model` comes
/// from decode_cut() with `whole` false.
[[nodiscard]] std::vector<RefinementStatePage>
splittable_part(const DecodedModel& model, std::span<const RefinementStatePage> pages);

/// Faces of a controller, rebuilt from the model: the base mesh with the pages' records split.
/// Refused like split_all(). The cost grows with the faces of the model and the split records.
///
/// Bytes, little-endian, faces in the order of their ids:
///
///     u32 vertices v, u32 faces f, f32 positions[3 v], u32 corners[3 f], f32 error_m[f],
///     u16 level[f], u16 0 if f is odd
///
/// Positions are in the model's frame, in metres. A face of the base mesh has level 0, one from a
/// record that record's depth; `error_m` bounds its distance from the source.
[[nodiscard]] Result<std::string, Refusal> cut_bytes(const DecodedModel& model,
                                                     std::span<const RefinementStatePage> pages);

} // namespace tactus::view
