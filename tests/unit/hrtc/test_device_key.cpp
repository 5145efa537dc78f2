// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/options/device_key.hpp"
#include "tests/shared/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <string_view>

namespace tactus::hrtc
{

namespace
{

std::string hex(const udp::Tag& tag)
{
    std::string text;
    for (const std::byte byte : tag)
    {
        constexpr std::string_view kDigits = "0123456789abcdef";
        text += kDigits[std::to_integer<std::size_t>(byte >> 4)];
        text += kDigits[std::to_integer<std::size_t>(byte & std::byte{15})];
    }
    return text;
}

/// Tags by Python's hashlib.blake2b(text, digest_size=16, key=bytes(range(32))).
TEST(DeviceKey, makes_keyed_tags_as_others_do)
{
    const tactus::test::TemporaryFolder folder("device_key");
    const std::filesystem::path path = folder.path() / "key";
    std::ofstream(path) << "000102030405060708090A0b0c0d0e0f"
                           "101112131415161718191a1b1c1d1e1f\r\n";
    std::filesystem::permissions(path, std::filesystem::perms::owner_read);
    const auto sut = read_device_key(path.string());
    ASSERT_TRUE(sut) << sut.error().text;
    const std::string_view text = "TCTD and what follows";
    EXPECT_EQ(hex(sut.value()->tag_of(std::as_bytes(std::span(text)))),
              "110df4e37d314fdbf2fd07711387cd1d");
    EXPECT_EQ(hex(sut.value()->tag_of({})), "3daf97bce7888fd59773c66bf647459c");
}

} // namespace

} // namespace tactus::hrtc
