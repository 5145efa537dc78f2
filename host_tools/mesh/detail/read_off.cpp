// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/detail/readers.hpp"
#include "host_tools/mesh/detail/text_cursor.hpp"
#include "transport/base/refusal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

/// OFF: keyword, counts, vertices, polygons; '#' starts a comment. Each vertex and polygon begins a
/// line and may continue in the next; text after the coordinates or the indices on its last line
/// (colours, normals) is skipped. The keyword may be missing, or attached to the counts as in the
/// files of ModelNet40.
namespace tactus::detail
{

namespace
{

/// Prefixes of the keyword: texture coordinates, colours and normals after a vertex's coordinates.
constexpr std::array<std::string_view, 8> kPrefixes{"", "c", "n", "cn", "st", "stc", "stn", "stcn"};

class OffReader
{
public:
    explicit OffReader(std::string_view text) : text_(text), cursor_(text) {}

    Result<MeshFile, Refusal> read()
    {
        if (auto error = read_keyword())
        {
            return *error;
        }
        if (auto error = read_counts())
        {
            return *error;
        }
        if (auto error = read_vertices())
        {
            return *error;
        }
        if (auto error = read_faces())
        {
            return *error;
        }
        if (!first_of_line().empty())
        {
            file_.notes.push_back(
                fmt::format("line {}: data after the last face left out", cursor_.line()));
        }
        note_missing_line_end(text_, file_.notes);
        return std::move(file_);
    }

private:
    /// Token of this line, comments excluded.
    std::string_view token_in_line()
    {
        const std::string_view token = cursor_.next_token_in_line();
        const std::size_t comment = token.find('#');
        if (comment == std::string_view::npos)
        {
            return token;
        }
        in_comment_ = true;
        return token.substr(0, comment);
    }

    std::string_view next_of_line() { return in_comment_ ? std::string_view{} : token_in_line(); }

    /// Next token of this line or of a later one.
    std::string_view next()
    {
        const std::string_view token = next_of_line();
        if (!token.empty() || !cursor_.skip_line())
        {
            return token;
        }
        return first_of_line();
    }

    /// First token of the next line that has one; empty at the end of the file.
    std::string_view first_of_line()
    {
        do
        {
            in_comment_ = false;
            if (const auto token = token_in_line(); !token.empty())
            {
                return token;
            }
        } while (cursor_.skip_line());
        return {};
    }

    /// Reads [ST][C][N]OFF in either case of letters; if it is missing, the first word is a count.
    std::optional<Refusal> read_keyword()
    {
        const std::string_view token = first_of_line();
        const std::string word = lower(token);
        const std::size_t at = word.find("off");
        if (at == std::string::npos && parse_integer(token))
        {
            first_count_ = token;
            return std::nullopt;
        }
        if (at == 1 && (word[0] == '4' || token.starts_with("nO")))
        {
            return cursor_.error("vertices of " + quote(token.substr(0, at + 3)) +
                                 " have other than three coordinates; OFF is read");
        }
        const std::string_view before = std::string_view(word).substr(0, at);
        const bool is_known = std::ranges::find(kPrefixes, before) != kPrefixes.end();
        if (at == std::string::npos || !is_known)
        {
            return cursor_.error(fmt::format("starts with {}; an OFF file starts with OFF, COFF, "
                                             "NOFF, CNOFF, STOFF or its counts",
                                             quote(token)));
        }
        first_count_ = token.substr(at + 3);
        return std::nullopt;
    }

    std::optional<Refusal> read_counts()
    {
        const std::string_view token = first_count_.empty() ? next() : first_count_;
        if (lower(token) == "binary")
        {
            return cursor_.error("is a binary OFF file; only text is read");
        }
        const std::size_t line = cursor_.line();
        const auto vertices = parse_integer(token);
        const auto faces = parse_integer(next());
        if (!vertices || !faces || *vertices < 0 || *faces < 0)
        {
            return cursor_.error("expected the numbers of vertices and faces (ASCII OFF)");
        }
        // With one number a line, the number of edges is on the next line.
        if (cursor_.line() != line)
        {
            next();
        }
        cursor_.skip_line();
        vertices_ = static_cast<std::uint64_t>(*vertices);
        faces_ = static_cast<std::uint64_t>(*faces);
        // A vertex has at least 6 bytes ("0 0 0" and a line end), a face at least 2.
        const std::uint64_t room = cursor_.remaining() + 1;
        if (vertices_ > room / 6 || faces_ > room / 2)
        {
            return cursor_.error(fmt::format("{} vertices and {} faces are declared, but only {} "
                                             "bytes follow",
                                             vertices_, faces_, cursor_.remaining()));
        }
        return std::nullopt;
    }

    std::optional<Refusal> read_vertices()
    {
        file_.mesh.positions.reserve(vertices_);
        for (std::uint64_t v = 0; v < vertices_; ++v)
        {
            std::array<double, 3> position{};
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                const auto token = axis == 0 ? first_of_line() : next();
                const auto number = parse_number(token);
                if (!number)
                {
                    return cursor_.error(fmt::format("vertex {} of {}: {} is {}", v, vertices_,
                                                     "xyz"[axis], no_number(token)));
                }
                position[axis] = *number;
            }
            file_.mesh.positions.push_back(position);
            cursor_.skip_line();
        }
        return std::nullopt;
    }

    std::optional<Refusal> read_faces()
    {
        PolygonSink polygons(file_.mesh);
        std::vector<std::uint32_t> corners;
        file_.mesh.faces.reserve(faces_);
        for (std::uint64_t f = 0; f < faces_; ++f)
        {
            const auto token = first_of_line();
            const auto count = parse_integer(token);
            if (!count || *count < 0)
            {
                return cursor_.error(fmt::format("face {} of {}: {} is not a number of corners", f,
                                                 faces_, quote(token)));
            }
            corners.clear();
            for (std::int64_t i = 0; i < *count; ++i)
            {
                const auto name = next();
                const auto index = parse_integer(name);
                if (!index || *index < 0 || static_cast<std::uint64_t>(*index) >= vertices_)
                {
                    return cursor_.error(
                        fmt::format("face {} of {}: vertex index {} is not in 0..{}", f, faces_,
                                    quote(name), static_cast<std::int64_t>(vertices_) - 1));
                }
                corners.push_back(static_cast<std::uint32_t>(*index));
            }
            polygons.add(corners);
            cursor_.skip_line();
        }
        polygons.finish(file_.notes);
        return std::nullopt;
    }

    std::string_view text_;
    TextCursor cursor_;
    bool in_comment_{false};
    std::string_view first_count_; ///< Part of the first count that is attached to the keyword.
    std::uint64_t vertices_{0};
    std::uint64_t faces_{0};
    MeshFile file_;
};

} // namespace

Result<MeshFile, Refusal> read_off(std::string_view text)
{
    return OffReader(without_byte_order_mark(text)).read();
}

} // namespace tactus::detail
