// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace tactus
{

namespace detail
{

/// Table of the reflected Castagnoli polynomial 0x82F63B78 (RFC 3720, appendix B.4).
constexpr std::array<std::uint32_t, 256> make_crc32c_table() noexcept
{
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t byte = 0; byte < 256; ++byte)
    {
        std::uint32_t value = byte;
        for (int bit = 0; bit < 8; ++bit)
        {
            value = (value >> 1U) ^ ((value & 1U) != 0 ? 0x82F6'3B78U : 0U);
        }
        table[byte] = value;
    }
    return table;
}

inline constexpr std::array<std::uint32_t, 256> kCrc32cTable = make_crc32c_table();

} // namespace detail

/// CRC-32C (Castagnoli) of the bytes: guards against noise, not against forgery. `before` is that
/// of bytes in front of them.
[[nodiscard]] constexpr std::uint32_t crc32c(std::span<const std::byte> bytes,
                                             std::uint32_t before = 0) noexcept
{
    std::uint32_t state = ~before;
    for (const std::byte byte : bytes)
    {
        state = detail::kCrc32cTable[(state ^ static_cast<std::uint32_t>(byte)) & 0xFFU] ^
                (state >> 8U);
    }
    return ~state;
}

} // namespace tactus
