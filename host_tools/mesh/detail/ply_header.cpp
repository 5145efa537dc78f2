// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/mesh/detail/ply_header.hpp"

#include "host_tools/mesh/detail/text_cursor.hpp"

#include <fmt/format.h>

#include <array>
#include <utility>

namespace tactus::detail
{

namespace
{

std::optional<PlyType> parse_type(std::string_view word)
{
    using Entry = std::pair<std::string_view, PlyType>;
    static constexpr std::array<Entry, 16> kTypes{{{"char", PlyType::int8},
                                                   {"int8", PlyType::int8},
                                                   {"uchar", PlyType::uint8},
                                                   {"uint8", PlyType::uint8},
                                                   {"short", PlyType::int16},
                                                   {"int16", PlyType::int16},
                                                   {"ushort", PlyType::uint16},
                                                   {"uint16", PlyType::uint16},
                                                   {"int", PlyType::int32},
                                                   {"int32", PlyType::int32},
                                                   {"uint", PlyType::uint32},
                                                   {"uint32", PlyType::uint32},
                                                   {"float", PlyType::float32},
                                                   {"float32", PlyType::float32},
                                                   {"double", PlyType::float64},
                                                   {"float64", PlyType::float64}}};
    for (const auto& [name, type] : kTypes)
    {
        if (name == word)
        {
            return type;
        }
    }
    return std::nullopt;
}

std::optional<PlyFormat> parse_format(std::string_view word)
{
    if (word == "ascii")
    {
        return PlyFormat::ascii;
    }
    if (word == "binary_little_endian")
    {
        return PlyFormat::little_endian;
    }
    if (word == "binary_big_endian")
    {
        return PlyFormat::big_endian;
    }
    return std::nullopt;
}

class HeaderReader
{
public:
    explicit HeaderReader(std::string_view bytes) : bytes_(bytes), cursor_(bytes) {}

    Result<PlyHeader, Refusal> read()
    {
        if (next_word() != "ply")
        {
            return Refusal{"is not a PLY file: its first line must be 'ply'"};
        }
        while (cursor_.skip_line())
        {
            const std::string word = next_word();
            if (word == "end_header")
            {
                return finish();
            }
            if (auto error = read_line(word))
            {
                return *error;
            }
        }
        return cursor_.error("the file ends before 'end_header'");
    }

private:
    /// Next word in lower case.
    std::string next_word() { return lower(cursor_.next_token_in_line()); }

    std::optional<Refusal> read_line(std::string_view word)
    {
        if (word == "format")
        {
            const std::string name = next_word();
            format_ = parse_format(name);
            return format_ ? std::nullopt
                           : std::optional(cursor_.error(fmt::format(
                                 "format {} is unknown; must be ascii, binary_little_endian or "
                                 "binary_big_endian",
                                 quote(name))));
        }
        if (word == "element")
        {
            return read_element();
        }
        if (word == "property")
        {
            return read_property();
        }
        if (word.empty() || word == "comment" || word == "obj_info")
        {
            return std::nullopt;
        }
        return cursor_.error("unknown word " + quote(word) + " in the header");
    }

    std::optional<Refusal> read_element()
    {
        const std::string name = next_word();
        const auto count = parse_integer(cursor_.next_token_in_line());
        if (!count || *count < 0)
        {
            return cursor_.error("element " + quote(name) + " has no count");
        }
        header_.elements.push_back({name, static_cast<std::uint64_t>(*count), {}});
        return std::nullopt;
    }

    std::optional<Refusal> read_property()
    {
        if (header_.elements.empty())
        {
            return cursor_.error("a property precedes the first element");
        }
        PlyProperty property;
        std::string word = next_word();
        if (word == "list")
        {
            word = next_word();
            property.count_type = parse_type(word);
            if (!property.count_type || !is_whole(*property.count_type))
            {
                return cursor_.error(quote(word) + " can't count a list; must be an integer type");
            }
            word = next_word();
        }
        const auto type = parse_type(word);
        property.name = cursor_.next_token_in_line();
        if (!type || property.name.empty())
        {
            return cursor_.error("property type " + quote(word) + " is unknown or has no name");
        }
        property.type = *type;
        header_.elements.back().properties.push_back(std::move(property));
        return std::nullopt;
    }

    Result<PlyHeader, Refusal> finish()
    {
        if (!format_)
        {
            return cursor_.error("the header has no 'format' line");
        }
        header_.lines = cursor_.line();
        cursor_.skip_line();
        header_.bytes = cursor_.position();
        // If lines end in CR, an LF after the last one is the first byte of the data.
        const std::string_view header = bytes_.substr(0, header_.bytes);
        if (header.ends_with("\r\n") && header.find('\n') == header.size() - 1)
        {
            --header_.bytes;
        }
        header_.format = *format_;
        return std::move(header_);
    }

    std::string_view bytes_;
    TextCursor cursor_;
    std::optional<PlyFormat> format_;
    PlyHeader header_;
};

} // namespace

bool is_whole(PlyType type)
{
    return type != PlyType::float32 && type != PlyType::float64;
}

std::size_t size_of(PlyType type)
{
    static constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
    return kSizes[static_cast<std::size_t>(type)];
}

Result<PlyHeader, Refusal> read_ply_header(std::string_view bytes)
{
    return HeaderReader(bytes).read();
}

} // namespace tactus::detail
