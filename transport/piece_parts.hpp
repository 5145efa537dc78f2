// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus
{

/// Bytes of each part of a header or base mesh except the last, which has the remainder.
inline constexpr std::size_t kPartBytes = std::size_t{28} << 10U;

/// Number of parts of a header or base mesh of `bytes` bytes.
[[nodiscard]] constexpr std::uint32_t parts_of(std::size_t bytes) noexcept
{
    return static_cast<std::uint32_t>((bytes + kPartBytes - 1) / kPartBytes);
}

/// Part number `part` of the bytes `whole`; empty beyond the last part.
[[nodiscard]] constexpr std::span<const std::byte> part_of(std::span<const std::byte> whole,
                                                           std::uint32_t part) noexcept
{
    const std::size_t begin = std::min(part * kPartBytes, whole.size());
    return whole.subspan(begin, std::min(kPartBytes, whole.size() - begin));
}

} // namespace tactus
