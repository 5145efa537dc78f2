// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/base_mesh.hpp"
#include "rt_core/spm/header.hpp"
#include "rt_core/spm/page.hpp"
#include "transport/front.hpp"
#include "transport/store/model_store.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

// One thread makes it, and waits for the file; then any may read it, several at once.
namespace tactus
{

/// Reads a piece in its coded form, verified against its hash; refused in words that name it.
using ReadPiece =
    std::function<Result<Done, Refusal>(ContentKey key, std::vector<std::byte>& coded)>;

/// A model's base mesh and its records in memory, parsed by the reader that the controller uses:
/// 128 B a record. The header's bytes must outlive it.
class DecodedModel
{
public:
    /// The base mesh and the chunks of these pages, which are the model's and each there once
    /// (asserted). What a page's `refined` names must be linked, for the rest nothing is promised:
    /// no record that isn't linked may be asked for. `name` is for `damage`, as below.
    [[nodiscard]] static DecodedModel decode_pages(const ModelHeader& header,
                                                   std::span<const FrontPage> pages,
                                                   const ReadPiece& read, const std::string& name,
                                                   std::vector<std::string>& damage);
    /// Reads and parses every piece and checks its hash. Each damaged one adds a line to `damage`
    /// that names file, piece and fault; what it holds is unspecified then.
    [[nodiscard]] static DecodedModel decode(const ModelStore& store,
                                             std::vector<std::string>& damage);

    /// Here and below ids must be the model's; nothing checks them.
    [[nodiscard]] const ModelHeader& header() const noexcept { return header_; }
    [[nodiscard]] const VsplitRecord& record(RecordId id) const noexcept
    {
        return page(chunk_of(id)).records[place_in_chunk(id)];
    }
    [[nodiscard]] const Page& page(ChunkId id) const noexcept { return pages_[slots_[id.value]]; }
    /// Of a chunk that is here a bit for each record that is linked, with all that it depends on.
    [[nodiscard]] std::uint64_t linked(ChunkId id) const noexcept
    {
        return linked_[slots_[id.value]];
    }
    /// Where a vertex is, in the model's frame.
    [[nodiscard]] const Vec3f& position_m(VertexId vertex) const noexcept
    {
        const ModelCounts counts = header_.counts();
        return counts.is_base(vertex) ? base_positions_m_[vertex.value]
                                      : record(counts.record_of(vertex)).position_m;
    }
    [[nodiscard]] const std::vector<BaseFace>& base_faces() const noexcept { return base_faces_; }
    /// The bound that a face state carries; error_in_quanta() reads it.
    [[nodiscard]] ErrorCode error_of(FaceId face, FaceState state) const noexcept
    {
        return state.is_base() ? base_faces_[face.value].error
                               : record(state.record()).error[state.place()];
    }
    /// Of all chunks, coded.
    [[nodiscard]] std::uint64_t chunk_bytes() const noexcept { return chunk_bytes_; }

private:
    DecodedModel(const ModelHeader& header, std::span<const FrontPage> pages);

    void parse_pieces(std::span<const FrontPage> pages, const ReadPiece& read,
                      const std::string& name, std::vector<std::string>& damage);
    void link_all(std::span<const FrontPage> pages, const std::string& name,
                  std::vector<std::string>& damage);

    ModelHeader header_;
    std::vector<Page> pages_;
    std::vector<std::uint64_t> linked_; ///< One each a page.
    std::vector<std::uint32_t> slots_;  ///< By chunk: where its page is, if it is here.
    std::vector<Vec3f> base_positions_m_;
    std::vector<BaseFace> base_faces_;
    std::vector<std::uint32_t> base_next_;
    std::uint64_t chunk_bytes_{0};
};

} // namespace tactus
