// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/ids.hpp"

#include <cstddef>
#include <span>

namespace tactus::fuzz
{

/// Writes every checksum and hash of a model's file anew, from the chunks up to the root hash, as
/// far as its parts lie where it says; the versions and the file's size become those that a reader
/// expects. A changed byte then reaches the checks behind the hashes, which it never would.
void seal_model(std::span<std::byte> file);

/// The last four bytes become the checksum of what stands before them; no effect on fewer.
void seal_piece(std::span<std::byte> piece);

/// The same for a coded chunk, whose checksum covers its number, too.
void seal_chunk(std::span<std::byte> chunk, ChunkId id);

} // namespace tactus::fuzz
