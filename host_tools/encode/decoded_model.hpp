// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/base_mesh.hpp"
#include "rt_core/spm/header.hpp"
#include "rt_core/spm/page.hpp"
#include "transport/store/model_store.hpp"

#include <cstdint>
#include <string>
#include <vector>

// One thread makes it, and waits for the file; then any may read it, several at once.
namespace tactus
{

/// A model's base mesh and all its records in memory, parsed by the reader that the controller
/// uses: 128 B a record. The store must outlive it.
class DecodedModel
{
public:
    /// Reads and parses every piece and checks its hash. Each damaged one adds a line to `damage`
    /// that names file, piece and fault; what it holds is unspecified then.
    [[nodiscard]] static DecodedModel decode(const ModelStore& store,
                                             std::vector<std::string>& damage);

    [[nodiscard]] const ModelHeader& header() const noexcept { return header_; }
    [[nodiscard]] const VsplitRecord& record(RecordId id) const noexcept
    {
        return pages_[chunk_of(id).value].records[place_in_chunk(id)];
    }
    [[nodiscard]] const Page& page(ChunkId id) const noexcept { return pages_[id.value]; }
    /// Where a vertex is, in the model's frame.
    [[nodiscard]] const Vec3f& position_m(VertexId vertex) const noexcept
    {
        const ModelCounts counts = header_.counts();
        return counts.is_base(vertex) ? base_positions_m_[vertex.value]
                                      : record(counts.record_of(vertex)).position_m;
    }
    [[nodiscard]] const std::vector<BaseFace>& base_faces() const noexcept { return base_faces_; }
    /// The bound that a face state carries.
    [[nodiscard]] ErrorCode error_of(FaceId face, FaceState state) const noexcept
    {
        return state.is_base() ? base_faces_[face.value].error
                               : record(state.record()).error[state.place()];
    }
    [[nodiscard]] std::uint64_t chunk_bytes() const noexcept { return chunk_bytes_; }

private:
    explicit DecodedModel(const ModelHeader& header);

    void parse_pieces(const ModelStore& store, std::vector<std::string>& damage);
    void link_all(const ModelStore& store, std::vector<std::string>& damage);

    ModelHeader header_;
    std::vector<Page> pages_;
    std::vector<Vec3f> base_positions_m_;
    std::vector<BaseFace> base_faces_;
    std::vector<std::uint32_t> base_next_;
    std::uint64_t chunk_bytes_{0};
};

} // namespace tactus
