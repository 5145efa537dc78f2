// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/face_history.hpp"
#include "host_tools/encode/numbering.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "rt_core/spm/header.hpp"
#include "rt_core/spm/index_page.hpp"
#include "rt_core/spm/star_resolver.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace tactus
{

/// Where records matter, and the vertices round each.
struct Influence
{
    std::vector<QuantumBox> chunks; ///< By ChunkId: a ball that misses it needs none of the chunk.
    std::vector<StarRing> rings;    ///< By RecordId.
};

/// One sweep over the collapses in their order, finest first.
///
/// A controller splits a record when a face of its fan, inflated by the face's bound, meets the
/// ball; or because something that depends on the record is split. So a record's box is that of
/// its inflated fan and of its star after the split, joined with the boxes of all that depends on
/// it. Those were collapsed earlier, so their boxes are complete when the sweep comes to it.
/// Linear; 52 B a record and a copy of the mesh's faces.
[[nodiscard]] Influence find_influence(const QuantisedMesh& mesh,
                                       const Simplification& simplification,
                                       const Numbering& numbering, const FaceHistory& history);

/// Holds nothing; joined with a box it is that box.
inline constexpr QuantumBox kEmptyBox{
    {std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::max(),
     std::numeric_limits<std::int32_t>::max()},
    {std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::min(),
     std::numeric_limits<std::int32_t>::min()}};

/// Grows `box` until it holds the other one, too.
void join(QuantumBox& box, const QuantumBox& other);

/// The least box that holds all of `boxes`, which are at least one.
[[nodiscard]] QuantumBox union_of(std::span<const QuantumBox> boxes);

/// A box as an index page stores it: in steps of the page's box, rounded outward.
[[nodiscard]] InfluenceBox relative_to(const QuantumBox& page, const QuantumBox& box);

} // namespace tactus
