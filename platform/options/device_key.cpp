// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/options/device_key.hpp"

#include "transport/base/printable.hpp"
#include "transport/base/read_file.hpp"

#include <fmt/format.h>
#include <sodium.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <system_error>

namespace tactus::hrtc
{

namespace
{

using Key = std::array<unsigned char, 32>;
static_assert(std::tuple_size_v<Key> >= crypto_generichash_blake2b_KEYBYTES_MIN);
static_assert(std::tuple_size_v<Key> <= crypto_generichash_blake2b_KEYBYTES_MAX);

class KeyedHash final : public udp::Authenticator
{
public:
    explicit KeyedHash(const Key& key) noexcept : key_(key) {}

    [[nodiscard]] udp::Tag tag_of(std::span<const std::byte> bytes) const noexcept override
    {
        std::array<unsigned char, std::tuple_size_v<udp::Tag>> tag{};
        crypto_generichash_blake2b(tag.data(), tag.size(),
                                   reinterpret_cast<const unsigned char*>(bytes.data()),
                                   bytes.size(), key_.data(), key_.size());
        return std::bit_cast<udp::Tag>(tag);
    }

private:
    Key key_;
};

constexpr std::string_view kSpace = " \t\r\n";

std::string_view trimmed(std::string_view text)
{
    text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
    return text.substr(0, text.find_last_not_of(kSpace) + 1);
}

/// True if others than owner and group may read the file.
bool is_open_to_all(const std::string& path)
{
    std::error_code error;
    const auto rights = std::filesystem::status(path, error).permissions();
    return !error && (rights & std::filesystem::perms::others_read) != std::filesystem::perms::none;
}

} // namespace

Result<std::shared_ptr<const udp::Authenticator>, Refusal> read_device_key(const std::string& path)
{
    const auto refused = [&path](std::string_view why)
    { return Refusal{fmt::format("--device-key: {}: {}", printable(path), why)}; };
    if (is_open_to_all(path))
    {
        return refused("all users may read the file; protect it with chmod 600");
    }
    const auto bytes = read_file(path);
    if (!bytes)
    {
        return refused(bytes.error().text);
    }
    const std::string_view digits = trimmed(bytes.value());
    Key key{};
    std::size_t made = 0;
    const bool is_hex = sodium_hex2bin(key.data(), key.size(), digits.data(), digits.size(),
                                       nullptr, &made, nullptr) == 0;
    if (!is_hex || digits.size() != 2 * key.size() || made != key.size())
    {
        return refused("must hold 64 hexadecimal digits and nothing else");
    }
    return std::shared_ptr<const udp::Authenticator>(std::make_shared<KeyedHash>(key));
}

} // namespace tactus::hrtc
