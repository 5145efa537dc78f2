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

/// What the kernel tells in files, below a root folder: "/" in the program, a made-up tree in
/// tests. Paths are absolute ("/proc/version"). Nothing here fails otherwise than by having no
/// answer.
class SystemFiles
{
public:
    static constexpr std::size_t kMostBytes = 64 * 1024; ///< Of a file; the rest is left unread.
    static constexpr std::size_t kMostNames = 16 * 1024; ///< Of a folder.

    explicit SystemFiles(std::filesystem::path root) : root_(std::move(root)) {}

    /// The first kMostBytes of a file; none when it can't be read or is none.
    [[nodiscard]] std::optional<std::string> bytes(const std::string& path) const;
    /// The same without white space at either end.
    [[nodiscard]] std::optional<std::string> text(const std::string& path) const;
    /// What is in a folder, sorted by name; empty when there is no such folder.
    [[nodiscard]] std::vector<std::string> names(const std::string& path) const;
    [[nodiscard]] bool is_there(const std::string& path) const;
    [[nodiscard]] bool is_folder(const std::string& path) const;

private:
    [[nodiscard]] std::filesystem::path below_root(const std::string& path) const;

    std::filesystem::path root_;
};

} // namespace tactus::doctor
