// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/face_history.hpp"
#include "host_tools/encode/influence.hpp"
#include "host_tools/encode/numbering.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "rt_core/spm/base_mesh.hpp"
#include "rt_core/spm/coded_record.hpp"
#include "rt_core/spm/page.hpp"
#include "rt_core/spm/ring_prediction.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus
{

/// A whole model in the numbering of the file, from which each piece can be coded separately. About
/// 180 B a face, besides the mesh and the simplification, which must outlive it.
class ModelPieces
{
public:
    ModelPieces(const PreparedMesh& prepared, const Simplification& simplification,
                unsigned threads);

    [[nodiscard]] const ModelCounts& counts() const noexcept { return numbering_.counts; }
    [[nodiscard]] const Numbering& numbering() const noexcept { return numbering_; }
    [[nodiscard]] std::uint32_t max_depth() const noexcept { return history_.max_depth; }
    [[nodiscard]] ErrorCode max_error() const noexcept { return history_.max_error; }
    /// Influence boxes by ChunkId, in quanta.
    [[nodiscard]] std::span<const QuantumBox> influence_boxes() const noexcept
    {
        return influence_.chunks;
    }

    [[nodiscard]] const VsplitRecord& record(RecordId id) const { return records_[id.value]; }
    /// Records of a chunk in their coded form.
    [[nodiscard]] std::vector<CodedRecord> chunk_records(ChunkId id) const;
    [[nodiscard]] std::vector<std::byte> coded_chunk(ChunkId id) const;
    [[nodiscard]] std::vector<std::byte> coded_base(const BaseLayout& layout) const;

private:
    [[nodiscard]] VsplitRecord make_record(RecordId id) const;
    [[nodiscard]] BaseFace base_face(FaceId id) const;
    [[nodiscard]] GridPosition position_of(VertexId vertex) const;
    [[nodiscard]] std::vector<GridPosition> ring_positions(RecordId id,
                                                           const VsplitRecord& record) const;

    const PreparedMesh& prepared_;
    const Simplification& simplification_;
    Numbering numbering_;
    FaceHistory history_;
    Influence influence_;
    std::vector<std::uint32_t> buckets_; ///< Buckets of left_full_buckets(), by face of the mesh.
    std::vector<VsplitRecord> records_;
    std::vector<Vec3f> base_positions_m_;
    std::vector<BaseFace> base_faces_;
};

/// The bucket (rank >> 3) of every face in the left-full median order of the mesh.
///
/// The faces are split repeatedly at a median of their centroids, along the longest axis of the
/// centroids' box; the left part gets the largest power of two below the count. The cells of the
/// order are therefore aligned: a face's rank is its path in a radix tree with bits as digits, and
/// eight consecutive ranks are one cell. Faces are compared by centroid, then by number, so the
/// order is deterministic. n log n; 16 B a face.
[[nodiscard]] std::vector<std::uint32_t> left_full_buckets(const QuantisedMesh& mesh);

} // namespace tactus
