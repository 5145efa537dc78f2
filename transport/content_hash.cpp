// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/content_hash.hpp"

#include "rt_core/base/assert.hpp"

#include <sodium.h>

#include <algorithm>
#include <cstring>

namespace tactus
{

RootHash root_hash(std::span<const std::byte> bytes) noexcept
{
    RootHash hash{};
    // No key: the hash identifies, it does not sign. Works without sodium_init(), which is for
    // random numbers.
    crypto_generichash_blake2b(hash.data(), hash.size(),
                               reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(),
                               nullptr, 0);
    return hash;
}

ContentHash content_hash(std::span<const std::byte> bytes) noexcept
{
    const RootHash whole = root_hash(bytes);
    ContentHash hash{};
    std::copy_n(whole.begin(), hash.size(), hash.begin());
    return hash;
}

ContentHash model_hash(std::span<const std::byte> header) noexcept
{
    TACTUS_ASSERT(header.size() >= kRootHashBytes + kChecksumBytes);
    ContentHash hash{};
    std::memcpy(hash.data(), header.last(kRootHashBytes + kChecksumBytes).data(), hash.size());
    return hash;
}

bool has_sound_root_hash(std::span<const std::byte> header) noexcept
{
    TACTUS_ASSERT(header.size() >= kRootHashBytes + kChecksumBytes);
    const auto hashed = header.first(header.size() - kRootHashBytes - kChecksumBytes);
    const RootHash hash = root_hash(hashed);
    return std::memcmp(hash.data(), header.data() + hashed.size(), hash.size()) == 0;
}

std::string hash_text(const ContentHash& hash)
{
    constexpr std::string_view digits = "0123456789abcdef";
    std::string text;
    for (const std::uint8_t byte : hash)
    {
        text += digits[byte >> 4U];
        text += digits[byte & 15U];
    }
    return text;
}

std::optional<ContentHash> parse_hash(std::string_view text) noexcept
{
    ContentHash hash{};
    if (text.size() != 2 * hash.size())
    {
        return std::nullopt;
    }
    for (std::size_t i = 0; i < text.size(); ++i)
    {
        const char c = text[i];
        const bool is_lower = c >= 'a' && c <= 'f';
        const bool is_upper = c >= 'A' && c <= 'F';
        if (!(c >= '0' && c <= '9') && !is_lower && !is_upper)
        {
            return std::nullopt;
        }
        const int digit = is_lower ? c - 'a' + 10 : is_upper ? c - 'A' + 10 : c - '0';
        hash[i / 2] = static_cast<std::uint8_t>(hash[i / 2] * 16 + digit);
    }
    return hash;
}

} // namespace tactus
