// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/plot/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <string_view>

namespace tactus::plot
{

namespace
{

/// True if the text would end or change the element of HTML or XML that contains it.
bool leaves_its_element(const std::string& text)
{
    const auto is_same = [](char a, char b)
    { return std::tolower(static_cast<unsigned char>(a)) == b; };
    for (const std::string_view end : {"</script", "</style", "<!--", "]]>"})
    {
        if (std::search(text.begin(), text.end(), end.begin(), end.end(), is_same) != text.end())
        {
            return true;
        }
    }
    return false;
}

/// Reads a file; returns the fault, empty if none.
std::string read_into(std::string& text, const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    text.assign(std::istreambuf_iterator<char>(file), {});
    if (!file || text.empty())
    {
        return fmt::format("{} can't be read; install Debian's package libjs-dygraphs",
                           path.string());
    }
    return leaves_its_element(text)
               ? fmt::format("{} contains text that would end its part of the page", path.string())
               : "";
}

} // namespace

ChartLibrary ChartLibrary::read(const std::filesystem::path& folder)
{
    ChartLibrary library;
    library.missing = read_into(library.script, folder / "dygraphs/dygraph.min.js");
    if (library.missing.empty())
    {
        library.missing = read_into(library.style, folder / "dygraphs/dygraph.min.css");
    }
    return library;
}

ChartLibrary ChartLibrary::packaged()
{
    return read(TACTUS_JAVASCRIPT_DIR);
}

} // namespace tactus::plot
