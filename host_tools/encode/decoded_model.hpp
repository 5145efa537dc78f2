// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/base_mesh.hpp"
#include "rt_core/spm/header.hpp"
#include "rt_core/spm/page.hpp"
#include "transport/refinement_state.hpp"
#include "transport/store/model_store.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

// One thread creates it, and waits for the file; then any thread may read it, several at once.
namespace tactus
{

/// Function that reads a coded piece into `coded` and verifies its hash; a refusal names the piece.
using ReadPiece =
    std::function<Result<Done, Refusal>(ContentKey key, std::vector<std::byte>& coded)>;

/// A model's base mesh and records in memory, parsed by the controller's reader: 128 B a record.
/// The header's bytes must outlive the object.
class DecodedModel
{
public:
    /// Decodes the base mesh and the chunks of these pages, which must be the model's and each
    /// occur once (asserted). A record in a page's `refined` that is not linked counts as damage.
    /// Records that are not linked must not be accessed. `name` precedes lines of `damage`, as in
    /// decode().
    [[nodiscard]] static DecodedModel decode_pages(const ModelHeader& header,
                                                   std::span<const RefinementStatePage> pages,
                                                   const ReadPiece& read, const std::string& name,
                                                   std::vector<std::string>& damage);
    /// Reads and parses every piece and checks its hash. Each damaged piece adds a line to `damage`
    /// with file, piece and fault; its content is then unspecified.
    [[nodiscard]] static DecodedModel decode(const ModelStore& store,
                                             std::vector<std::string>& damage);

    /// Header of the model. Ids passed to the functions below must be ids of this model; they are
    /// not checked.
    [[nodiscard]] const ModelHeader& header() const noexcept { return header_; }
    [[nodiscard]] const VsplitRecord& record(RecordId id) const noexcept
    {
        return page(chunk_of(id)).records[place_in_chunk(id)];
    }
    [[nodiscard]] const Page& page(ChunkId id) const noexcept { return pages_[slots_[id.value]]; }
    /// Linked records of a resident chunk, one bit each; all their dependencies are resident too.
    [[nodiscard]] std::uint64_t linked(ChunkId id) const noexcept
    {
        return linked_[slots_[id.value]];
    }
    /// Position of a vertex, in the model's frame.
    [[nodiscard]] const Vec3f& position_m(VertexId vertex) const noexcept
    {
        const ModelCounts counts = header_.counts();
        return counts.is_base(vertex) ? base_positions_m_[vertex.value]
                                      : record(counts.record_of(vertex)).position_m;
    }
    [[nodiscard]] const std::vector<BaseFace>& base_faces() const noexcept { return base_faces_; }
    /// Bound of a face state; error_in_quanta() decodes it.
    [[nodiscard]] ErrorCode error_of(FaceId face, FaceState state) const noexcept
    {
        return state.is_base() ? base_faces_[face.value].error
                               : record(state.record()).error[state.place()];
    }
    /// Coded bytes of all chunks.
    [[nodiscard]] std::uint64_t chunk_bytes() const noexcept { return chunk_bytes_; }

private:
    DecodedModel(const ModelHeader& header, std::span<const RefinementStatePage> pages);

    void parse_pieces(std::span<const RefinementStatePage> pages, const ReadPiece& read,
                      const std::string& name, std::vector<std::string>& damage);
    void link_all(std::span<const RefinementStatePage> pages, const std::string& name,
                  std::vector<std::string>& damage);

    ModelHeader header_;
    std::vector<Page> pages_;
    std::vector<std::uint64_t> linked_; ///< Linked records of each page, one bit each.
    /// Index into `pages_`, by chunk; 0 if the chunk is not resident.
    std::vector<std::uint32_t> slots_;
    std::vector<Vec3f> base_positions_m_;
    std::vector<BaseFace> base_faces_;
    std::vector<std::uint32_t> base_next_;
    std::uint64_t chunk_bytes_{0};
};

} // namespace tactus
