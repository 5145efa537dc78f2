// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/base/read_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

namespace tactus
{

namespace
{

/// Reason why the path cannot be read; empty if it can.
std::string why_not_a_file(const std::filesystem::path& path)
{
    std::error_code code;
    const auto status = std::filesystem::status(path, code);
    if (status.type() == std::filesystem::file_type::not_found)
    {
        return "no such file";
    }
    if (status.type() == std::filesystem::file_type::none)
    {
        return code.message();
    }
    if (status.type() == std::filesystem::file_type::directory)
    {
        return "is a directory, not a file";
    }
    if (status.type() != std::filesystem::file_type::regular)
    {
        return "is not a regular file";
    }
    return {};
}

} // namespace

Result<std::string, Refusal> read_file(const std::filesystem::path& path, std::uintmax_t most)
{
    if (const std::string reason = why_not_a_file(path); !reason.empty())
    {
        return Refusal{reason};
    }
    std::error_code code;
    const std::uintmax_t size = std::filesystem::file_size(path, code);
    std::ifstream file(path, std::ios::binary);
    if (code || !file)
    {
        return Refusal{std::string("can't be opened: ") + std::strerror(errno)};
    }
    if (size == 0)
    {
        return Refusal{"is empty"};
    }
    if (size > most)
    {
        return Refusal{"has " + std::to_string(size) + " bytes; at most " + std::to_string(most) +
                       " are read"};
    }
    std::string bytes(size, '\0');
    file.read(bytes.data(), static_cast<std::streamsize>(size));
    if (static_cast<std::uintmax_t>(file.gcount()) != size)
    {
        return Refusal{"only " + std::to_string(file.gcount()) + " of " + std::to_string(size) +
                       " bytes could be read"};
    }
    return bytes;
}

} // namespace tactus
