// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/detail/readers.hpp"
#include "transport/base/read_file.hpp"

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>

namespace tactus::detail
{

namespace
{

constexpr std::size_t kStepBytes = std::size_t{1} << 20U;

/// Reads all bytes of a file descriptor, to its end.
Result<std::string, Refusal> read_to_end(int descriptor)
{
    std::string bytes;
    for (;;)
    {
        const std::size_t so_far = bytes.size();
        bytes.resize(so_far + kStepBytes);
        const ssize_t count = ::read(descriptor, bytes.data() + so_far, kStepBytes);
        bytes.resize(so_far + static_cast<std::size_t>(count > 0 ? count : 0));
        if (count < 0 && errno != EINTR)
        {
            return Refusal{std::string("can't be read: ") + std::strerror(errno)};
        }
        if (count == 0)
        {
            return bytes.empty() ? Result<std::string, Refusal>(Refusal{"is empty"})
                                 : Result<std::string, Refusal>(std::move(bytes));
        }
    }
}

} // namespace

Result<std::string, Refusal> read_input(const std::filesystem::path& path)
{
    if (path == kStandardInput)
    {
        return read_to_end(STDIN_FILENO);
    }
    std::error_code code;
    const auto type = std::filesystem::status(path, code).type();
    if (type != std::filesystem::file_type::fifo && type != std::filesystem::file_type::character &&
        type != std::filesystem::file_type::socket)
    {
        return read_file(path);
    }
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0)
    {
        return Refusal{std::string("can't be opened: ") + std::strerror(errno)};
    }
    auto bytes = read_to_end(descriptor);
    ::close(descriptor);
    return bytes;
}

std::string input_name(const std::filesystem::path& path)
{
    return path == kStandardInput ? "standard input" : path.string();
}

} // namespace tactus::detail
