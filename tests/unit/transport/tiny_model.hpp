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

/// How large a made-up model is and which one.
struct TinyModelSpec
{
    std::uint32_t seed{1};
    std::uint32_t base_faces{8};
    std::uint32_t records{200};
    bool shuffled_ids{false}; ///< Dependencies may have larger ids than their dependents.
    /// Influence boxes of chunks are slices of x, apart from each other; otherwise everything.
    bool boxes_in_a_row{false};
};

/// A made-up model: a mesh of random vertices that grows by random splits, with borders. Header,
/// base and index are written with code of its own, so that reader and writer check each other;
/// chunks by the product's coder. `records[i].next` is what the whole model's links must be.
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
    /// One chunk of a model that says this of all its records.
    [[nodiscard]] std::vector<std::byte> chunk_of(ChunkId id,
                                                  std::span<const CodedRecord> all) const;
};

[[nodiscard]] TinyModel make_tiny_model(const TinyModelSpec& spec);

} // namespace tactus::test
