// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/base_mesh.hpp"
#include "rt_core/spm/header.hpp"
#include "rt_core/spm/index_page.hpp"
#include "rt_core/spm/page.hpp"

#include <cstddef>
#include <span>

/// What holds of every piece that a parser accepts: docs/spm-format.md, sections 2, 6 and 8,
/// written down a second time, with the numbers of that page.
namespace tactus::fuzz
{

/// `bytes` are those that the header was parsed from.
[[nodiscard]] bool is_lawful_header(const ModelHeader& header, std::span<const std::byte> bytes);

[[nodiscard]] bool is_lawful_base(const ModelHeader& header, const BaseMesh& mesh);

[[nodiscard]] bool is_lawful_index_page(const ModelCounts& counts, IndexPageId id,
                                        const IndexPage& page, std::span<const ChunkEntry> entries);

/// A page as parse leaves it, its records waiting.
[[nodiscard]] bool is_lawful_parsed_page(const ModelHeader& header, ChunkId id, const Page& page);

/// A record as the linker leaves it.
[[nodiscard]] bool is_lawful_linked(const ModelHeader& header, RecordId id,
                                    const VsplitRecord& record);

} // namespace tactus::fuzz
