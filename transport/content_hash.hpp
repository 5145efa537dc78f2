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

// Any thread: functions of their arguments alone; a hash takes time by the bytes, so not the haptic
// one.
namespace tactus
{

/// BLAKE2b-256 of a header up to its root hash; a header carries it whole.
using RootHash = std::array<std::uint8_t, kRootHashBytes>;

/// The full 256 bits; only a header's root hash is stored whole. No allocation.
[[nodiscard]] RootHash root_hash(std::span<const std::byte> bytes) noexcept;

/// The first 128 bits of BLAKE2b-256, as they name base mesh, index page, chunk and model.
[[nodiscard]] ContentHash content_hash(std::span<const std::byte> bytes) noexcept;

/// The hash that names a model: the first half of the root hash that its header carries.
/// `header` is exactly one header, of 36 bytes at least (asserted); nothing is verified.
[[nodiscard]] ContentHash model_hash(std::span<const std::byte> header) noexcept;

/// Whether the root hash that a header carries, likewise, is the hash of what stands before it.
[[nodiscard]] bool has_sound_root_hash(std::span<const std::byte> header) noexcept;

/// A hash as people write it: 32 lower-case hexadecimal digits.
[[nodiscard]] std::string hash_text(const ContentHash& hash);

/// Reads 32 hexadecimal digits of either case; nothing for any other text.
[[nodiscard]] std::optional<ContentHash> parse_hash(std::string_view text) noexcept;

} // namespace tactus
