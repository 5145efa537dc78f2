// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/byte_writer.hpp"
#include "rt_core/spm/base_mesh.hpp"
#include "rt_core/spm/coded_record.hpp"
#include "rt_core/spm/header.hpp"
#include "rt_core/spm/index_page.hpp"
#include "rt_core/spm/ring_prediction.hpp"

#include <cstddef>
#include <span>
#include <vector>

/// Encoders for rt_core's parse functions: each parse function reads the result of its encoder back
/// to the same content.
namespace tactus
{

/// Codes the base mesh, `positions` and `faces` in the order of their ids; inverse of
/// parse_base_mesh().
[[nodiscard]] std::vector<std::byte> encode_base_mesh(std::span<const GridPosition> positions,
                                                      std::span<const BaseFace> faces,
                                                      const BaseLayout& layout);

/// Codes the records of one chunk, 1 .. 64, in coder version 3; inverse of parse_chunk().
[[nodiscard]] std::vector<std::byte> encode_chunk(ChunkId id, const ModelCounts& counts,
                                                  std::span<const CodedRecord> records);

/// Codes one box and one entry for each chunk of the page, 1 .. 64; inverse of parse_index_page().
[[nodiscard]] std::vector<std::byte> encode_index_page(IndexPageId id,
                                                       std::span<const InfluenceBox> boxes,
                                                       std::span<const ChunkEntry> entries);

/// Codes a header, with root hash and checksum; inverse of ModelHeader::parse(). The sizes in
/// `fields` must equal those of the spans.
[[nodiscard]] std::vector<std::byte> encode_header(const HeaderFields& fields,
                                                   std::span<const IndexPageEntry> index,
                                                   std::span<const std::byte> region_bits);

} // namespace tactus
