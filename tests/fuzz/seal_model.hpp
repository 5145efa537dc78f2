// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/ids.hpp"

#include <cstddef>
#include <span>

namespace tactus::fuzz
{

/// Corrects every checksum and hash of a model's file, from the chunks up to the root hash, as far
/// as its parts are where it says; versions and file size become the expected ones. A changed byte
/// then reaches the checks behind the hashes.
void seal_model(std::span<std::byte> file);

/// Replaces the last four bytes by the checksum of the others; no effect on fewer.
void seal_piece(std::span<std::byte> piece);

/// The same for a coded chunk, whose checksum also covers its number.
void seal_chunk(std::span<std::byte> chunk, ChunkId id);

} // namespace tactus::fuzz
