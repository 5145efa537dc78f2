// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/spm/header.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

// Any thread except the haptic one, since the time of a hash grows with its bytes. Results depend
// on the arguments alone.
namespace tactus
{

/// BLAKE2b-256 of the header's bytes before its root hash, which the header stores in full.
using RootHash = std::array<std::uint8_t, kRootHashBytes>;

/// All 256 bits of BLAKE2b-256 of `bytes`. No allocation.
[[nodiscard]] RootHash root_hash(std::span<const std::byte> bytes) noexcept;

/// First 128 bits of BLAKE2b-256 of `bytes`; identifies a base mesh, index page, chunk or model.
[[nodiscard]] ContentHash content_hash(std::span<const std::byte> bytes) noexcept;

/// Hash that identifies a model: the first half of the root hash stored in `header`, unverified.
/// `header` is exactly one header of at least 36 bytes (asserted).
[[nodiscard]] ContentHash model_hash(std::span<const std::byte> header) noexcept;

/// True if the root hash in a header is the hash of the bytes before it. `header` is exactly one
/// header, of 36 bytes at least (asserted).
[[nodiscard]] bool has_sound_root_hash(std::span<const std::byte> header) noexcept;

/// Text of a hash: 32 lower-case hexadecimal digits.
[[nodiscard]] std::string hash_text(const ContentHash& hash);

/// Hash from 32 hexadecimal digits of either case; none for any other text.
[[nodiscard]] std::optional<ContentHash> parse_hash(std::string_view text) noexcept;

} // namespace tactus
