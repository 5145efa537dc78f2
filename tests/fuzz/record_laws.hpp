// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/header.hpp"
#include "rt_core/spm/page.hpp"

/// What holds of every record that a parser accepts and of every one that is linked:
/// docs/internals/spm-format.md, sections 6 and 8, written down a second time, with its numbers.
namespace tactus::fuzz
{

/// A page as parse leaves it, its records waiting.
[[nodiscard]] bool is_lawful_parsed_page(const ModelHeader& header, ChunkId id, const Page& page);

/// A record as the linker leaves it.
[[nodiscard]] bool is_lawful_linked(const ModelHeader& header, RecordId id,
                                    const VsplitRecord& record);

} // namespace tactus::fuzz
