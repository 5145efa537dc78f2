// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/detail/readers.hpp"
#include "host_tools/mesh/detail/text_cursor.hpp"
#include "platform/base/refusal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>

/// STL: loose triangles, each with three positions of its own; prepare_mesh() welds them. A binary
/// header may begin with "solid", so the length decides first.
namespace tactus::detail
{

namespace
{

constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kTriangleBytes = 50; ///< Normal, three positions as f32; 2 bytes unused.

std::uint64_t binary_triangles(std::string_view bytes)
{
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + kHeaderBytes - sizeof(count), sizeof(count));
    return count;
}

bool has_binary_length(std::string_view bytes)
{
    return bytes.size() >= kHeaderBytes &&
           bytes.size() == kHeaderBytes + kTriangleBytes * binary_triangles(bytes);
}

std::string lower(std::string_view token)
{
    std::string text(token);
    std::transform(text.begin(), text.end(), text.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return text;
}

bool is_text(std::string_view bytes)
{
    const auto control = [](unsigned char c) { return c < ' ' && (c < '\t' || c > '\r'); };
    const auto start = bytes.substr(0, 512);
    return lower(TextCursor(bytes).next_token()) == "solid" &&
           std::none_of(start.begin(), start.end(), control);
}

Result<MeshFile, Refusal> read_binary(std::string_view bytes)
{
    MeshFile file;
    const std::uint64_t triangles = binary_triangles(bytes);
    file.mesh.positions.reserve(3 * triangles);
    file.mesh.faces.reserve(triangles);
    for (std::uint64_t t = 0; t < triangles; ++t)
    {
        std::array<float, 12> values{};
        std::memcpy(values.data(), bytes.data() + kHeaderBytes + t * kTriangleBytes,
                    sizeof(values));
        const auto first = static_cast<std::uint32_t>(file.mesh.positions.size());
        for (std::size_t corner = 1; corner <= 3; ++corner)
        {
            file.mesh.positions.push_back({static_cast<double>(values[3 * corner]),
                                           static_cast<double>(values[3 * corner + 1]),
                                           static_cast<double>(values[3 * corner + 2])});
        }
        file.mesh.faces.push_back({first, first + 1, first + 2});
    }
    return file;
}

class TextStlReader
{
public:
    explicit TextStlReader(std::string_view text) : cursor_(text) {}

    /// One or more "solid name ... endsolid name".
    Result<MeshFile, Refusal> read()
    {
        std::string word = lower(cursor_.next_token());
        while (!word.empty())
        {
            if (word != "solid")
            {
                return cursor_.error("expected 'solid', found " + quote(word));
            }
            cursor_.skip_line();
            for (word = lower(cursor_.next_token()); word != "endsolid";
                 word = lower(cursor_.next_token()))
            {
                if (auto error = read_facet(word))
                {
                    return *error;
                }
            }
            cursor_.skip_line();
            word = lower(cursor_.next_token());
        }
        polygons_.finish(file_.notes);
        return std::move(file_);
    }

private:
    std::optional<Refusal> expect(std::string_view wanted, std::string_view found)
    {
        if (lower(found) == wanted)
        {
            return std::nullopt;
        }
        return cursor_.error(found.empty()
                                 ? fmt::format("the file ends where '{}' is due", wanted)
                                 : fmt::format("expected '{}', found {}", wanted, quote(found)));
    }

    /// "facet normal x y z outer loop vertex ... endloop endfacet"; the normal is passed over.
    std::optional<Refusal> read_facet(std::string_view first)
    {
        if (auto error = expect(first.empty() ? "endsolid" : "facet", first))
        {
            return error;
        }
        cursor_.skip_line();
        if (auto error = expect("outer", cursor_.next_token()))
        {
            return error;
        }
        if (auto error = expect("loop", cursor_.next_token()))
        {
            return error;
        }
        std::vector<std::uint32_t> corners;
        std::string_view word = cursor_.next_token();
        for (; lower(word) == "vertex"; word = cursor_.next_token())
        {
            if (auto error = read_position())
            {
                return error;
            }
            corners.push_back(static_cast<std::uint32_t>(file_.mesh.positions.size() - 1));
        }
        polygons_.add(corners);
        if (auto error = expect(corners.size() < 3 ? "vertex" : "endloop", word))
        {
            return error;
        }
        return expect("endfacet", cursor_.next_token());
    }

    std::optional<Refusal> read_position()
    {
        auto& position = file_.mesh.positions.emplace_back();
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const auto token = cursor_.next_token();
            const auto number = parse_number(token);
            if (!number)
            {
                return cursor_.error(
                    fmt::format("{} is {}, not a number", "xyz"[axis], quote(token)));
            }
            position[axis] = *number;
        }
        return std::nullopt;
    }

    TextCursor cursor_;
    MeshFile file_;
    PolygonSink polygons_{file_.mesh};
};

} // namespace

Result<MeshFile, Refusal> read_stl(std::string_view bytes)
{
    if (has_binary_length(bytes))
    {
        return read_binary(bytes);
    }
    if (is_text(bytes))
    {
        return TextStlReader(bytes).read();
    }
    if (bytes.size() < kHeaderBytes)
    {
        return Refusal{fmt::format("has {} bytes and doesn't begin with 'solid'; a binary STL "
                                   "has at least {}",
                                   bytes.size(), kHeaderBytes)};
    }
    return Refusal{fmt::format("the header at byte 80 declares {} triangles, which makes {} "
                               "bytes; the file has {}",
                               binary_triangles(bytes),
                               kHeaderBytes + kTriangleBytes * binary_triangles(bytes),
                               bytes.size())};
}

} // namespace tactus::detail
