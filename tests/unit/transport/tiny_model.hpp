// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/content_key.hpp"
#include "rt_core/spm/header.hpp"
#include "rt_core/spm/star_resolver.hpp"
#include "tests/shared/temporary_folder.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace tactus::test
{

/// Size and seed of a synthetic model.
struct TinyModelSpec
{
    std::uint32_t seed{1};
    std::uint32_t base_faces{8};
    std::uint32_t records{200};
    bool shuffled_ids{false}; ///< Dependencies may have larger ids than their dependents.
    /// Chunks' influence boxes are separate slices of x; otherwise everything.
    bool boxes_in_a_row{false};
};

/// Synthetic model: a mesh of random vertices that grows by random splits, with borders. Header,
/// base and index are written by separate code, so that reader and writer check each other; chunks
/// by the product's coder. `records[i].next` are the links of the whole model.
struct TinyModel
{
    ModelCounts counts;
    std::vector<std::byte> header;
    std::vector<std::byte> base;
    std::vector<std::vector<std::byte>> index_pages;
    std::vector<std::vector<std::byte>> chunks;
    std::vector<std::byte> file;
    std::vector<Vec3f> base_positions_m;
    std::vector<BaseFace> base_faces;
    std::vector<VsplitRecord> records;
    std::vector<StarRing> rings;
    std::vector<CodedRecord> coded;
    std::vector<std::uint32_t> base_next;

    [[nodiscard]] std::span<const std::byte> piece(ContentKey key) const;
    /// Chunk of a model with this content for all its records.
    [[nodiscard]] std::vector<std::byte> chunk_of(ChunkId id,
                                                  std::span<const CodedRecord> all) const;
};

[[nodiscard]] TinyModel make_tiny_model(const TinyModelSpec& spec);

} // namespace tactus::test
