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

/// Influence boxes of chunks, and the vertices around each record.
struct Influence
{
    /// Boxes by ChunkId: a sphere outside a chunk's box needs none of its records.
    std::vector<QuantumBox> chunks;
    std::vector<StarRing> rings; ///< Rings by RecordId.
};

/// Computes the boxes in one sweep over the collapses in their order, finest first.
///
/// A controller splits a record if a face of its fan, inflated by the face's bound, meets the
/// sphere, or if a dependent record is split. A record's box therefore covers its inflated fan, its
/// star after the split, and the boxes of all its dependents. These were collapsed earlier, so
/// their boxes are complete when the sweep reaches the record. Linear; 52 B a record and a copy of
/// the mesh's faces.
[[nodiscard]] Influence find_influence(const QuantisedMesh& mesh,
                                       const Simplification& simplification,
                                       const Numbering& numbering, const FaceHistory& history);

/// Empty box; join() of it with a box gives that box.
inline constexpr QuantumBox kEmptyBox{
    {std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::max(),
     std::numeric_limits<std::int32_t>::max()},
    {std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::min(),
     std::numeric_limits<std::int32_t>::min()}};

/// Extends `box` to include `other`.
void join(QuantumBox& box, const QuantumBox& other);

/// The least box that includes all of `boxes`; there must be at least one.
[[nodiscard]] QuantumBox union_of(std::span<const QuantumBox> boxes);

/// Converts a box to the form of an index page: steps of the page's box, rounded outward.
[[nodiscard]] InfluenceBox relative_to(const QuantumBox& page, const QuantumBox& box);

} // namespace tactus
