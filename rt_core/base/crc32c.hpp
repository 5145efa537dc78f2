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

/// CRC-32 of each byte value with a reflected polynomial.
constexpr std::array<std::uint32_t, 256> make_crc32_table(std::uint32_t polynomial) noexcept
{
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t byte = 0; byte < 256; ++byte)
    {
        std::uint32_t value = byte;
        for (int bit = 0; bit < 8; ++bit)
        {
            value = (value >> 1U) ^ ((value & 1U) != 0 ? polynomial : 0U);
        }
        table[byte] = value;
    }
    return table;
}

template <std::uint32_t kPolynomial>
inline constexpr std::array<std::uint32_t, 256> kCrc32Table = make_crc32_table(kPolynomial);

} // namespace detail

/// CRC-32 of the bytes with a reflected polynomial: guards against noise, not against forgery.
/// `before` is the CRC of the bytes in front of them.
template <std::uint32_t kPolynomial>
[[nodiscard]] constexpr std::uint32_t crc32_by(std::span<const std::byte> bytes,
                                               std::uint32_t before = 0) noexcept
{
    std::uint32_t state = ~before;
    for (const std::byte byte : bytes)
    {
        state =
            detail::kCrc32Table<kPolynomial>[(state ^ static_cast<std::uint32_t>(byte)) & 0xFFU] ^
            (state >> 8U);
    }
    return ~state;
}

/// CRC-32C (Castagnoli; RFC 3720, appendix B.4).
[[nodiscard]] constexpr std::uint32_t crc32c(std::span<const std::byte> bytes,
                                             std::uint32_t before = 0) noexcept
{
    return crc32_by<0x82F6'3B78U>(bytes, before);
}

} // namespace tactus
