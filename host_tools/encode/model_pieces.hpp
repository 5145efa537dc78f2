// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/face_history.hpp"
#include "host_tools/encode/influence.hpp"
#include "host_tools/encode/numbering.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "rt_core/spm/base_mesh.hpp"
#include "rt_core/spm/page.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus
{

/// A whole model in the numbers of the file, from which each piece can be coded by itself. About
/// 100 B a face, besides the mesh and the simplification, which must outlive it.
class ModelPieces
{
public:
    ModelPieces(const PreparedMesh& prepared, const Simplification& simplification);

    [[nodiscard]] const ModelCounts& counts() const noexcept { return numbering_.counts; }
    [[nodiscard]] const Numbering& numbering() const noexcept { return numbering_; }
    [[nodiscard]] std::uint32_t max_depth() const noexcept { return history_.max_depth; }
    [[nodiscard]] ErrorCode max_error() const noexcept { return history_.max_error; }
    /// By ChunkId, in quanta.
    [[nodiscard]] std::span<const QuantumBox> influence_boxes() const noexcept
    {
        return influence_.chunks;
    }

    [[nodiscard]] VsplitRecord record(RecordId id) const;
    [[nodiscard]] std::vector<std::byte> coded_chunk(ChunkId id) const;
    [[nodiscard]] std::vector<std::byte> coded_base() const;

private:
    [[nodiscard]] BaseFace base_face(FaceId id) const;

    const PreparedMesh& prepared_;
    const Simplification& simplification_;
    Numbering numbering_;
    FaceHistory history_;
    Influence influence_;
    std::vector<std::uint32_t> buckets_; ///< By face of the mesh.
};

} // namespace tactus
