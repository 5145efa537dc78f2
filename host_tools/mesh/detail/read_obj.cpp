// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/detail/readers.hpp"
#include "host_tools/mesh/detail/text_cursor.hpp"
#include "platform/base/refusal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

/// Wavefront OBJ: "v" and "f" lines; texture coordinates, normals, groups and materials are passed
/// over. Indices count from 1, or backwards from the last vertex so far when negative. A face may
/// name vertices that come later in the file.
namespace tactus::detail
{

namespace
{

/// What a line may begin with that says nothing of the surface.
constexpr std::array<std::string_view, 37> kPassedOver{
    "vt",        "vn",     "vp",     "g",      "o",        "s",        "mg",   "usemtl",
    "mtllib",    "usemap", "maplib", "bevel",  "c_interp", "d_interp", "lod",  "shadow_obj",
    "trace_obj", "ctech",  "stech",  "cstype", "deg",      "bmat",     "step", "parm",
    "trim",      "hole",   "scrv",   "sp",     "end",      "con",      "call", "csh",
    "bsp",       "bzp",    "cdc",    "cdp",    "res"};

class ObjReader
{
public:
    explicit ObjReader(std::string_view text) : text_(text), cursor_(text) {}

    Result<MeshFile, Refusal> read()
    {
        do
        {
            if (auto error = read_line(next_word()))
            {
                return *error;
            }
        } while (cursor_.skip_line());
        if (largest_index_ > file_.mesh.positions.size())
        {
            return Refusal{fmt::format("line {}: vertex index {} is out of range; the file has "
                                       "{} vertices",
                                       largest_line_, largest_index_, file_.mesh.positions.size())};
        }
        polygons_.finish(file_.notes);
        if (left_out_ > 0)
        {
            file_.notes.push_back(
                fmt::format("{} points, lines, curves or free-form surfaces left out", left_out_));
        }
        if (not_understood_ > 0)
        {
            file_.notes.push_back(fmt::format("{} lines not understood, the first is line {}",
                                              not_understood_, first_not_understood_));
        }
        note_missing_line_end(text_, file_.notes);
        return std::move(file_);
    }

private:
    /// The next token of the logical line: a backslash at the end of a line continues it.
    std::string_view next_word()
    {
        std::string_view word = cursor_.next_token_in_line();
        while (word == "\\" && cursor_.skip_line())
        {
            word = cursor_.next_token_in_line();
        }
        return word;
    }

    std::optional<Refusal> read_line(std::string_view keyword)
    {
        if (keyword == "v")
        {
            return read_vertex();
        }
        if (keyword == "f" || keyword == "fo") // "fo" is the older name of "f".
        {
            return read_face();
        }
        if (keyword == "p" || keyword == "l" || keyword == "curv" || keyword == "curv2" ||
            keyword == "surf")
        {
            ++left_out_;
        }
        else if (!keyword.empty() && keyword[0] != '#' &&
                 std::ranges::find(kPassedOver, keyword) == kPassedOver.end())
        {
            first_not_understood_ = not_understood_ == 0 ? cursor_.line() : first_not_understood_;
            ++not_understood_;
        }
        return std::nullopt;
    }

    std::optional<Refusal> read_vertex()
    {
        auto& position = file_.mesh.positions.emplace_back();
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const auto word = next_word();
            const auto number = parse_number(word);
            if (!number)
            {
                return cursor_.error(fmt::format("vertex {}: {} is {}, not a number",
                                                 file_.mesh.positions.size(), "xyz"[axis],
                                                 quote(word)));
            }
            position[axis] = *number;
        }
        return std::nullopt;
    }

    std::optional<Refusal> read_face()
    {
        corners_.clear();
        for (auto word = next_word(); !word.empty() && word[0] != '#'; word = next_word())
        {
            const auto index = parse_integer(word.substr(0, word.find('/')));
            const auto so_far = static_cast<std::int64_t>(file_.mesh.positions.size());
            if (!index || *index == 0 || *index < -so_far || *index > kLargestIndex)
            {
                return cursor_.error(fmt::format("face corner {} names no vertex; must be 1..n or "
                                                 "-{}..-1",
                                                 quote(word), so_far));
            }
            const auto absolute =
                static_cast<std::uint64_t>(*index > 0 ? *index : so_far + 1 + *index);
            if (absolute > largest_index_)
            {
                largest_index_ = absolute;
                largest_line_ = cursor_.line();
            }
            corners_.push_back(static_cast<std::uint32_t>(absolute - 1));
        }
        if (corners_.size() < 3)
        {
            return cursor_.error(
                fmt::format("a face has {} corners; must have at least 3", corners_.size()));
        }
        polygons_.add(corners_);
        return std::nullopt;
    }

    static constexpr std::int64_t kLargestIndex = 0xFFFF'FFFF;

    std::string_view text_;
    TextCursor cursor_;
    MeshFile file_;
    PolygonSink polygons_{file_.mesh};
    std::vector<std::uint32_t> corners_;
    std::uint64_t largest_index_{0};
    std::size_t largest_line_{0};
    std::uint64_t left_out_{0};
    std::uint64_t not_understood_{0};
    std::size_t first_not_understood_{0};
};

} // namespace

Result<MeshFile, Refusal> read_obj(std::string_view text)
{
    return ObjReader(text).read();
}

} // namespace tactus::detail
