// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/keys/archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace tactus::keys
{

namespace
{

constexpr std::size_t kBlock = 512;

/// Header of a file in the ustar format of POSIX.1-1988.
std::string header(const std::string& name, std::size_t bytes, unsigned mode, char type,
                   std::time_t time)
{
    std::string block(kBlock, '\0');
    const auto put = [&block](std::size_t at, std::string_view text)
    { std::ranges::copy(text, block.begin() + static_cast<std::ptrdiff_t>(at)); };
    put(0, name.substr(0, 99));
    put(100, fmt::format("{:07o}", mode));
    put(108, fmt::format("{:07o}", 0)); // User and group: root.
    put(116, fmt::format("{:07o}", 0));
    put(124, fmt::format("{:011o}", bytes));
    put(136, fmt::format("{:011o}", time));
    put(148, "        "); // Blanks stand for the checksum while it is computed.
    block[156] = type;
    put(257, std::string_view("ustar\0"
                              "00",
                              8));
    put(265, "root");
    put(297, "root");
    unsigned sum = 0;
    for (const char byte : block)
    {
        sum += static_cast<unsigned char>(byte);
    }
    put(148, fmt::format("{:06o}", sum));
    block[154] = '\0';
    return block;
}

} // namespace

std::string archive(const std::string& folder, const std::vector<ArchivedFile>& files,
                    std::time_t time)
{
    std::string text = header(folder + "/", 0, 0755, '5', time);
    for (const ArchivedFile& file : files)
    {
        text += header(folder + "/" + file.name, file.bytes.size(), file.is_secret ? 0600 : 0644,
                       '0', time);
        text += file.bytes;
        text.append((kBlock - file.bytes.size() % kBlock) % kBlock, '\0');
    }
    return text.append(2 * kBlock, '\0');
}

} // namespace tactus::keys
