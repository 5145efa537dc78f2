// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/base_mesh.hpp"
#include "rt_core/spm/header.hpp"
#include "rt_core/spm/index_page.hpp"
#include "rt_core/spm/page.hpp"

#include <cstddef>
#include <span>

/// Laws of every piece that a parser accepts: docs/internals/spm-format.md, sections 2, 6, 8,
/// written a second time, with the numbers of that page.
/// Laws of every record that a parser accepts and of every linked one:
/// docs/internals/spm-format.md, sections 6 and 8, written a second time, with its numbers.
namespace tactus::fuzz
{

/// True for a lawful page after parsing, with unlinked records.
[[nodiscard]] bool is_lawful_parsed_page(const ModelHeader& header, ChunkId id, const Page& page);

/// True for a lawful record after linking.
[[nodiscard]] bool is_lawful_linked(const ModelHeader& header, RecordId id,
                                    const VsplitRecord& record);

[[nodiscard]] inline bool is_in(double value, double low, double high)
{
    return value >= low && value <= high;
}

/// True for a lawful header; `bytes` are those that it was parsed from.
[[nodiscard]] bool is_lawful_header(const ModelHeader& header, std::span<const std::byte> bytes);

[[nodiscard]] bool is_lawful_base(const ModelHeader& header, const BaseMesh& mesh);

[[nodiscard]] bool is_lawful_index_page(const ModelCounts& counts, IndexPageId id,
                                        const IndexPage& page, std::span<const ChunkEntry> entries);

/// True for whole quanta in 0 .. extent.
[[nodiscard]] bool is_on_grid(const ModelHeader& header, const Vec3f& position_m);

} // namespace tactus::fuzz
