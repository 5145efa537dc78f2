// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::doctor
{

/// Files of the kernel below a root folder: "/" in the program, a made-up tree in tests. Paths are
/// absolute ("/proc/version"). A failure gives an empty result.
class SystemFiles
{
public:
    static constexpr std::size_t kMostBytes = 64 * 1024; ///< Most bytes read of a file; the rest is
                                                         ///< ignored.
    static constexpr std::size_t kMostNames = 16 * 1024; ///< Most names read of a folder.

    explicit SystemFiles(std::filesystem::path root) : root_(std::move(root)) {}

    /// First kMostBytes of a file; none if it can't be read or is a folder.
    [[nodiscard]] std::optional<std::string> bytes(const std::string& path) const;
    /// Contents without white space at either end.
    [[nodiscard]] std::optional<std::string> text(const std::string& path) const;
    /// Names in a folder, sorted; empty if there is no such folder.
    [[nodiscard]] std::vector<std::string> names(const std::string& path) const;
    [[nodiscard]] bool is_there(const std::string& path) const;
    [[nodiscard]] bool is_folder(const std::string& path) const;

private:
    [[nodiscard]] std::filesystem::path below_root(const std::string& path) const;

    std::filesystem::path root_;
};

} // namespace tactus::doctor
