// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/detail/readers.hpp"
#include "host_tools/mesh/detail/text_cursor.hpp"
#include "transport/base/number_form.hpp"
#include "transport/base/refusal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>

/// STL: separate triangles with three positions each; prepare_mesh() welds them. A binary header
/// may begin with "solid", so the length decides first. Text is read word by word; its lines are
/// ignored.
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

    /// Reads one or more "solid name ... endsolid name".
    Result<MeshFile, Refusal> read()
    {
        std::string word = next_word();
        while (word == "solid")
        {
            skip_name("facet");
            if (auto error = read_solid())
            {
                return *error;
            }
            skip_name("solid");
            word = next_word();
        }
        if (!word.empty())
        {
            file_.notes.push_back(
                fmt::format("line {}: data after the last 'endsolid' left out", cursor_.line()));
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
                                 ? fmt::format("the file ends where '{}' is expected", wanted)
                                 : fmt::format("expected '{}', found {}", wanted, quote(found)));
    }

    /// Next word in lower case; "end loop" is one word.
    std::string next_word()
    {
        std::string word = lower(cursor_.next_token());
        return word == "end" ? word + lower(cursor_.next_token()) : word;
    }

    /// Finds a facet on the rest of this line. If one begins there, moves the cursor before it and
    /// returns true.
    static bool finds_facet_in_line(TextCursor& cursor)
    {
        constexpr int kWordsBetween = 5; // "normal x y z outer".
        for (TextCursor here = cursor;; here = cursor)
        {
            const std::string word = lower(cursor.next_token_in_line());
            if (word.empty())
            {
                return false;
            }
            TextCursor ahead = cursor;
            for (int i = 0; word == "facet" && i < kWordsBetween; ++i)
            {
                if (lower(ahead.next_token_in_line()) == "outer")
                {
                    cursor = here;
                    return true;
                }
            }
        }
    }

    /// Skips a solid's name, which ends with the line. In a text of one line the name ends at the
    /// word `due`: "facet", or "solid" with a facet after it.
    void skip_name(std::string_view due)
    {
        TextCursor ahead = cursor_;
        for (TextCursor here = ahead;; here = ahead)
        {
            const std::string word = lower(ahead.next_token_in_line());
            if (word.empty())
            {
                cursor_.skip_line();
                return;
            }
            TextCursor facet = due == "solid" ? ahead : here;
            if (word == due && finds_facet_in_line(facet) &&
                (due == "solid" || facet.position() == here.position()))
            {
                cursor_ = here;
                return;
            }
        }
    }

    std::optional<Refusal> read_solid()
    {
        std::string word = next_word();
        std::size_t passed_over = 0;
        while (!word.empty() && word != "facet" && word != "endsolid") // A name of several lines.
        {
            ++passed_over;
            cursor_.skip_line();
            word = next_word();
        }
        if (passed_over > 0 && word.empty())
        {
            return cursor_.error("expected 'facet' or 'endsolid' after 'solid'");
        }
        if (passed_over > 0)
        {
            file_.notes.push_back(fmt::format("line {}: {} left out before the first facet",
                                              cursor_.line(), counted(passed_over, "line")));
        }
        for (; word != "endsolid"; word = next_word())
        {
            if (auto error = read_facet(word))
            {
                return error;
            }
        }
        return std::nullopt;
    }

    /// Reads "facet normal x y z outer loop vertex ... endloop endfacet"; words before "outer" are
    /// skipped.
    std::optional<Refusal> read_facet(std::string_view first)
    {
        if (auto error = expect(first.empty() ? "endsolid" : "facet", first))
        {
            return error;
        }
        std::string opening = next_word();
        while (!opening.empty() && opening != "outer" && opening != "vertex" &&
               opening != "facet" && opening != "endfacet" && opening != "endsolid")
        {
            opening = next_word();
        }
        if (auto error = expect("outer", opening))
        {
            return error;
        }
        if (auto error = expect("loop", next_word()))
        {
            return error;
        }
        std::vector<std::uint32_t> corners;
        std::string word = next_word();
        for (; word == "vertex"; word = next_word())
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
        return expect("endfacet", next_word());
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
                return cursor_.error(fmt::format("{} is {}", "xyz"[axis], no_number(token)));
            }
            position[axis] = *number;
        }
        return std::nullopt;
    }

    TextCursor cursor_;
    MeshFile file_;
    PolygonSink polygons_{file_.mesh};
};

/// Reads a binary file whose length does not match its count. A tail may be a second file, which is
/// read too, or padding, which is ignored. Refuses a file that is too short, and a tail that could
/// be further triangles.
Result<MeshFile, Refusal> read_binary_with_tail(std::string_view bytes)
{
    const std::uint64_t triangles = binary_triangles(bytes);
    const std::uint64_t declared = kHeaderBytes + kTriangleBytes * triangles;
    const std::string counts = fmt::format(
        "the header at byte 80 declares {} triangles, which need {} bytes; the file has {}",
        triangles, declared, bytes.size());
    if (triangles == 0 || bytes.size() < declared)
    {
        return Refusal{counts};
    }
    const std::string_view tail = bytes.substr(declared);
    const bool is_padding = std::ranges::all_of(tail, [&](char c) { return c == tail.front(); });
    if (!is_padding && tail.size() % kTriangleBytes == 0)
    {
        return Refusal{fmt::format("{}, and the rest has room for {} more", counts,
                                   tail.size() / kTriangleBytes)};
    }
    auto file = read_binary(bytes.substr(0, declared));
    if (!file)
    {
        return file;
    }
    if (is_padding || !has_binary_length(tail))
    {
        file.value().notes.push_back(counted(tail.size(), "byte") +
                                     " after the last triangle left out");
        return file;
    }
    auto second = read_binary(tail);
    TriangleMesh& mesh = file.value().mesh;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    const TriangleMesh& more = second.value().mesh;
    mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
    for (const auto& [a, b, c] : more.faces)
    {
        mesh.faces.push_back({first + a, first + b, first + c});
    }
    file.value().notes.emplace_back("two STL files in one; both are read");
    return file;
}

} // namespace

Result<MeshFile, Refusal> read_stl(std::string_view bytes)
{
    if (has_binary_length(bytes))
    {
        return read_binary(bytes);
    }
    const std::string_view text = without_byte_order_mark(bytes);
    if (is_text(text))
    {
        return TextStlReader(text).read();
    }
    if (bytes.size() < kHeaderBytes)
    {
        return Refusal{fmt::format("has {} bytes and doesn't begin with 'solid'; a binary STL "
                                   "has at least {}",
                                   bytes.size(), kHeaderBytes)};
    }
    return read_binary_with_tail(bytes);
}

} // namespace tactus::detail
