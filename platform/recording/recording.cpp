// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/recording.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace tactus
{

Result<Recording, Refusal> Recording::read(const std::string& path)
{
    std::error_code error;
    const auto status = std::filesystem::status(path, error);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    {
        return Refusal{path + ": is not a file but a directory, device or pipe"};
    }
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    std::ifstream file(path, std::ios::binary);
    if (error || !file)
    {
        return Refusal{path +
                       ": cannot be opened: " + (error ? error.message() : std::strerror(errno))};
    }
    std::vector<std::byte> bytes(size);
    if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size)))
    {
        return Refusal{path + ": at byte " + std::to_string(file.gcount()) +
                       ": can't be read further: " + std::strerror(errno)};
    }
    return parse(bytes, path);
}

std::string Recording::missing() const
{
    if (cut_at_)
    {
        return "the file is incomplete: after frame " + std::to_string(frame_count_ - 1) +
               ", at byte " + std::to_string(*cut_at_) + ", no section is complete";
    }
    return lost_from_ == kNoFrame
               ? ""
               : "the recorder lost frame " + std::to_string(lost_from_) + " and all later ones";
}

std::span<const std::byte> Recording::piece(std::uint32_t model, ContentKey key) const noexcept
{
    const auto at = pieces_.find({model, key.kind, key.number});
    return at == pieces_.end() ? std::span<const std::byte>{} : std::span(at->second);
}

} // namespace tactus
