// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/detail/readers.hpp"
#include "host_tools/mesh/detail/text_cursor.hpp"
#include "platform/base/refusal.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>

/// OFF: keyword, counts, one vertex per line, one polygon per line; '#' starts a comment. What
/// stands behind the coordinates or the indices on a line (colours, normals) is passed over.
namespace tactus::detail
{

namespace
{

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
            return cursor_.error(fmt::format("data after the last of {} faces", faces_));
        }
        note_missing_line_end(text_, file_.notes);
        return std::move(file_);
    }

private:
    /// A token of this line, comments left out.
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

    /// The first token of the next line that has one; empty at the end of the file.
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

    std::optional<Refusal> read_keyword()
    {
        const std::string_view keyword = first_of_line();
        if (keyword == "OFF" || keyword == "COFF" || keyword == "NOFF" || keyword == "CNOFF" ||
            keyword == "STOFF")
        {
            return std::nullopt;
        }
        return cursor_.error(
            fmt::format("starts with {}; an OFF file starts with OFF, COFF, NOFF, CNOFF or STOFF",
                        quote(keyword)));
    }

    std::optional<Refusal> read_counts()
    {
        std::string_view token = next_of_line();
        if (token.empty())
        {
            cursor_.skip_line();
            token = first_of_line();
        }
        const auto vertices = parse_integer(token);
        const auto faces = parse_integer(next_of_line());
        if (!vertices || !faces || *vertices < 0 || *faces < 0)
        {
            return cursor_.error("expected the numbers of vertices and faces (ASCII OFF)");
        }
        cursor_.skip_line();
        vertices_ = static_cast<std::uint64_t>(*vertices);
        faces_ = static_cast<std::uint64_t>(*faces);
        // A vertex is at least "0 0 0\n", a face at least "0\n".
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
                const auto token = axis == 0 ? first_of_line() : next_of_line();
                const auto number = parse_number(token);
                if (!number)
                {
                    return cursor_.error(fmt::format("vertex {} of {}: {} is {}, not a number", v,
                                                     vertices_, "xyz"[axis], quote(token)));
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
                const auto name = next_of_line();
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
    std::uint64_t vertices_{0};
    std::uint64_t faces_{0};
    MeshFile file_;
};

} // namespace

Result<MeshFile, Refusal> read_off(std::string_view text)
{
    return OffReader(text).read();
}

} // namespace tactus::detail
