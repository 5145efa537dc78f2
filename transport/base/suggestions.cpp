// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/base/suggestions.hpp"

#include "transport/base/printable.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <system_error>
#include <utility>
#include <vector>

namespace tactus
{

namespace
{

constexpr std::size_t kFilesShown = 5;
/// Maximum number of entries that are read, since a folder may have millions.
constexpr std::size_t kEntriesMost = 10'000;

} // namespace

std::string files_near(const std::filesystem::path& missing, std::string_view ending)
{
    std::error_code code;
    const std::string whole = missing.string() + std::string(ending);
    if (std::filesystem::is_regular_file(whole, code))
    {
        return "; " + printable_line(whole) + " exists";
    }
    const std::filesystem::path folder = missing.parent_path();
    const std::string shown = printable_line(folder.string());
    if (!folder.empty() && !std::filesystem::is_directory(folder, code))
    {
        return "; no such folder: " + shown;
    }
    return "; " + (folder.empty() ? "this folder" : shown) + " has " +
           files_in(folder.empty() ? "." : folder, ending);
}

std::string files_in(const std::filesystem::path& folder, std::string_view ending)
{
    std::vector<std::string> names;
    std::error_code code;
    std::size_t entries = 0;
    for (std::filesystem::directory_iterator at(folder, code), end;
         !code && at != end && entries < kEntriesMost; at.increment(code), ++entries)
    {
        std::string name = at->path().filename().string();
        if (name.size() > ending.size() && name.ends_with(ending))
        {
            names.push_back(std::move(name));
        }
    }
    if (names.empty())
    {
        return "no " + std::string(ending);
    }
    std::ranges::sort(names);
    std::string text;
    for (std::size_t i = 0; i < std::min(names.size(), kFilesShown); ++i)
    {
        text += (i == 0 ? "" : ", ") + printable_line(names[i]);
    }
    return names.size() > kFilesShown
               ? text + " and " + std::to_string(names.size() - kFilesShown) + " more"
               : text;
}

namespace
{

std::size_t letters_between(std::string_view one, std::string_view other)
{
    std::vector<std::size_t> row(other.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < one.size(); ++i)
    {
        std::size_t diagonal = std::exchange(row[0], i + 1);
        for (std::size_t j = 0; j < other.size(); ++j)
        {
            const std::size_t exchanged = diagonal + (one[i] == other[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({exchanged, diagonal + 1, row[j] + 1});
        }
    }
    return row.back();
}

} // namespace

std::string nearest_word(std::string_view word, std::span<const std::string_view> words)
{
    std::string_view nearest;
    std::size_t least = word.size() / 3 + 2;
    for (const std::string_view other : words)
    {
        const std::size_t letters = letters_between(word, other);
        // So few edits keep at least one letter.
        if (letters < std::min(least, other.size()))
        {
            least = letters;
            nearest = other;
        }
    }
    return std::string(nearest);
}

} // namespace tactus
