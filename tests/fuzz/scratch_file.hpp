// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/fuzz/law.hpp"
#include "tests/shared/temporary_folder.hpp"

#include <cstddef>
#include <fcntl.h>
#include <filesystem>
#include <span>
#include <unistd.h>

namespace tactus::fuzz
{

/// File with new content for each input, for readers that take a path.
class ScratchFile
{
public:
    /// Creates the file `name`, whose extension readers of meshes use. Ends the program if the disk
    /// refuses.
    explicit ScratchFile(const char* name)
        : path_(folder_.path() / name)
        , file_(::open(path_.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0600))
    {
        require(file_ >= 0, "a temporary file can be made");
    }
    ~ScratchFile() { ::close(file_); }
    ScratchFile(const ScratchFile&) = delete;
    ScratchFile& operator=(const ScratchFile&) = delete;

    void replace(std::span<const std::byte> content)
    {
        const auto bytes = static_cast<ssize_t>(content.size());
        require(::pwrite(file_, content.data(), content.size(), 0) == bytes &&
                    ::ftruncate(file_, static_cast<off_t>(bytes)) == 0,
                "a temporary file can be written");
    }
    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

private:
    test::TemporaryFolder folder_{"fuzz"};
    std::filesystem::path path_;
    int file_;
};

} // namespace tactus::fuzz
