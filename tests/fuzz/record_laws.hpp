// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/header.hpp"
#include "rt_core/spm/page.hpp"

/// Laws of every record that a parser accepts and of every linked one:
/// docs/internals/spm-format.md, sections 6 and 8, written a second time, with its numbers.
namespace tactus::fuzz
{

/// True for a lawful page after parsing, with unlinked records.
[[nodiscard]] bool is_lawful_parsed_page(const ModelHeader& header, ChunkId id, const Page& page);

/// True for a lawful record after linking.
[[nodiscard]] bool is_lawful_linked(const ModelHeader& header, RecordId id,
                                    const VsplitRecord& record);

} // namespace tactus::fuzz
