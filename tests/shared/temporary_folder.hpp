// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <stdlib.h>
#include <string>
#include <string_view>

namespace tactus::test
{

/// New temporary folder, removed with its content by the destructor.
class TemporaryFolder
{
public:
    explicit TemporaryFolder(const std::string& name = "test")
    {
        std::string path =
            (std::filesystem::temp_directory_path() / ("tactus-" + name + "-XXXXXX")).string();
        if (::mkdtemp(path.data()) == nullptr)
        {
            throw std::runtime_error("no temporary folder: " + path);
        }
        path_ = path;
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

    std::filesystem::path write(const std::string& name, std::string_view text) const
    {
        // The old file is removed first: overwriting makes some file systems wait for the disk.
        std::filesystem::remove(path_ / name);
        std::ofstream(path_ / name, std::ios::binary) << text;
        return path_ / name;
    }
    std::filesystem::path write(const std::string& name, std::span<const std::byte> bytes) const
    {
        return write(name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    }
    [[nodiscard]] std::size_t files() const
    {
        const std::filesystem::directory_iterator entries(path_);
        return static_cast<std::size_t>(std::distance(begin(entries), end(entries)));
    }

private:
    std::filesystem::path path_;
};

} // namespace tactus::test
