// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/detail/readers.hpp"
#include "host_tools/mesh/detail/text_cursor.hpp"
#include "transport/base/number_form.hpp"
#include "transport/base/refusal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

/// Wavefront OBJ: "v" and "f" lines; texture coordinates, normals, groups and materials are
/// skipped. Indices count from 1, or backwards from the last vertex so far if negative. A face may
/// use vertices that come later in the file.
namespace tactus::detail
{

namespace
{

/// Keywords of lines with names that do not affect the surface. A backslash at the end of a name
/// does not continue the line, as it does in a line of numbers.
constexpr std::array<std::string_view, 15> kPassedOver{
    "g",     "o",        "s",        "mg",  "usemtl",     "mtllib",    "usemap", "maplib",
    "bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj", "call"};
constexpr std::array<std::string_view, 22> kNumbersPassedOver{
    "vt",   "vn",   "vp", "ctech", "stech", "cstype", "deg", "bmat", "step", "parm", "trim",
    "hole", "scrv", "sp", "end",   "con",   "csh",    "bsp", "bzp",  "cdc",  "cdp",  "res"};
constexpr std::size_t kLongestKeyword = 16;

class ObjReader
{
public:
    explicit ObjReader(std::string_view text) : text_(text), cursor_(text) {}

    Result<MeshFile, Refusal> read()
    {
        do
        {
            if (auto error = read_line(cursor_.next_token_in_line()))
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
        if (weights_ > 0)
        {
            file_.notes.push_back(
                counted(weights_, "vertex", "vertices") +
                " with a weight other than 1: x, y and z are divided by the weight");
        }
        if (left_out_ > 0)
        {
            file_.notes.push_back(counted(left_out_, "element") +
                                  " left out: points, lines, curves or free-form surfaces");
        }
        if (not_understood_ > 0)
        {
            file_.notes.push_back(fmt::format("{} not understood, the first is line {}",
                                              counted(not_understood_, "line"),
                                              first_not_understood_));
        }
        note_missing_line_end(text_, file_.notes);
        return std::move(file_);
    }

private:
    /// Next token of the logical line: a backslash at the end of a line, after a blank or attached
    /// to a word, continues it.
    std::string_view next_word()
    {
        std::string_view word = cursor_.next_token_in_line();
        while (word.ends_with('\\') && TextCursor(cursor_).next_token_in_line().empty())
        {
            word.remove_suffix(1);
            if (!cursor_.skip_line() || !word.empty())
            {
                break;
            }
            word = cursor_.next_token_in_line();
        }
        return word;
    }

    std::optional<Refusal> read_line(std::string_view first)
    {
        const std::string keyword = lower(first.substr(0, kLongestKeyword));
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
            skip_words();
        }
        else if (std::ranges::find(kNumbersPassedOver, keyword) != kNumbersPassedOver.end())
        {
            skip_words();
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
                return cursor_.error(fmt::format("vertex {}: {} is {}", file_.mesh.positions.size(),
                                                 "xyz"[axis], no_number(word)));
            }
            position[axis] = *number;
        }
        divide_by_weight(position);
        return std::nullopt;
    }

    /// Divides the position by a fourth number on the line, the weight of homogeneous coordinates.
    /// Exactly three numbers after the position are a colour. A point at infinity is no position,
    /// so a weight of 0 is ignored.
    void divide_by_weight(std::array<double, 3>& position)
    {
        const auto weight = parse_number(next_word());
        if (!weight || *weight == 1.0 || *weight == 0.0)
        {
            return;
        }
        std::size_t more = 0;
        while (parse_number(next_word()))
        {
            ++more;
        }
        if (more == 0 || more == 3)
        {
            ++weights_;
            for (double& c : position)
            {
                c /= *weight;
            }
        }
    }

    void skip_words()
    {
        while (!next_word().empty())
        {
        }
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
    std::uint64_t weights_{0}; ///< Vertices that were divided by a weight.
    std::uint64_t not_understood_{0};
    std::size_t first_not_understood_{0};
};

} // namespace

Result<MeshFile, Refusal> read_obj(std::string_view text)
{
    return ObjReader(without_byte_order_mark(text)).read();
}

} // namespace tactus::detail
