// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/doctor/machine_view.hpp"

#include <algorithm>
#include <fstream>
#include <string_view>
#include <system_error>

namespace tactus::doctor
{

std::filesystem::path SystemFiles::below_root(const std::string& path) const
{
    return root_ / std::filesystem::path(path).relative_path();
}

std::optional<std::string> SystemFiles::bytes(const std::string& path) const
{
    if (!is_there(path) || is_folder(path))
    {
        return std::nullopt;
    }
    std::ifstream file(below_root(path), std::ios::binary);
    std::string content(kMostBytes, '\0');
    file.read(content.data(), static_cast<std::streamsize>(content.size()));
    // A file shorter than the buffer sets failbit, not badbit.
    if (!file.is_open() || file.bad())
    {
        return std::nullopt;
    }
    content.resize(static_cast<std::size_t>(file.gcount()));
    return content;
}

std::optional<std::string> SystemFiles::text(const std::string& path) const
{
    constexpr std::string_view kWhite{" \t\r\n\v\f\0", 7};
    const std::optional<std::string> content = bytes(path);
    if (!content)
    {
        return std::nullopt;
    }
    const std::size_t first = content->find_first_not_of(kWhite);
    if (first == std::string::npos)
    {
        return std::string();
    }
    return content->substr(first, content->find_last_not_of(kWhite) - first + 1);
}

std::vector<std::string> SystemFiles::names(const std::string& path) const
{
    std::vector<std::string> names;
    std::error_code error;
    std::filesystem::directory_iterator at(below_root(path), error);
    while (!error && at != std::filesystem::directory_iterator() && names.size() < kMostNames)
    {
        names.push_back(at->path().filename().string());
        at.increment(error);
    }
    std::ranges::sort(names);
    return names;
}

bool SystemFiles::is_there(const std::string& path) const
{
    std::error_code error;
    return std::filesystem::exists(below_root(path), error);
}

bool SystemFiles::is_folder(const std::string& path) const
{
    std::error_code error;
    return std::filesystem::is_directory(below_root(path), error);
}

} // namespace tactus::doctor
