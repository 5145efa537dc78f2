// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>

namespace tactus::fuzz
{

/// A file whose content is replaced for each input, for readers that want a path. In a folder of
/// its own, which goes with it.
class ScratchFile
{
public:
    /// `name` with its extension; readers of meshes go by that. Ends the program when the disk
    /// refuses.
    explicit ScratchFile(const char* name);
    ~ScratchFile();
    ScratchFile(const ScratchFile&) = delete;
    ScratchFile& operator=(const ScratchFile&) = delete;

    void replace(std::span<const std::byte> content);

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

private:
    std::filesystem::path path_;
    int file_{-1};
};

} // namespace tactus::fuzz
