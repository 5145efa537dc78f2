// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/simplify/simplify.hpp"
#include "rt_core/spm/ids.hpp"

#include <cstdint>
#include <vector>

namespace tactus
{

/// File numbers of the vertices, faces and collapses of a simplification.
///
/// Vertices and faces of the base come first, in their source order. Records are sorted into tiers,
/// coarsest first (rt_core/spm/tiers.hpp). Inside a tier they follow the Morton code of their
/// vertex, so that a chunk covers one small area. The dependencies of a record were collapsed after
/// it, so they are in the same tier or a coarser one.
struct Numbering
{
    ModelCounts counts;
    /// Index into Simplification::collapses, by record.
    std::vector<std::uint32_t> collapse_of_record;
    std::vector<VertexId> vertex_ids;         ///< Id by vertex of the mesh.
    std::vector<FaceId> face_ids;             ///< Id by face of the mesh.
    std::vector<std::uint32_t> base_vertices; ///< Vertex of the mesh, by VertexId.
    std::vector<std::uint32_t> base_faces;    ///< Index into Simplification::base_faces, by FaceId.

    [[nodiscard]] RecordId record_of(const Collapse& collapse) const noexcept
    {
        return counts.record_of(vertex_ids[collapse.vertex]);
    }
};

/// Numbers a model. Deterministic; n log n, about 40 B a face while running. `simplification` must
/// come from `mesh` and have fewer than kMaxRecords collapses.
[[nodiscard]] Numbering number_model(const QuantisedMesh& mesh,
                                     const Simplification& simplification);

} // namespace tactus
