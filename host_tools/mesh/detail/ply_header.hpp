// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::detail
{

enum class PlyFormat
{
    ascii,
    little_endian,
    big_endian,
};

enum class PlyType
{
    int8,
    uint8,
    int16,
    uint16,
    int32,
    uint32,
    float32,
    float64,
};

[[nodiscard]] std::size_t size_of(PlyType type);
[[nodiscard]] bool is_whole(PlyType type);

/// A value, or a list of values, of each entry of an element.
struct PlyProperty
{
    std::string name;
    PlyType type{};
    std::optional<PlyType> count_type; ///< Type of the count; present for a list.
};

/// A table of the file, such as its vertices.
struct PlyElement
{
    std::string name;
    std::uint64_t count{0};
    std::vector<PlyProperty> properties;
};

/// Layout of the data behind the header.
struct PlyHeader
{
    PlyFormat format{};
    std::vector<PlyElement> elements;
    std::size_t bytes{0}; ///< Offset of the data.
    std::size_t lines{0};
};

/// Reads up to and including "end_header". The words are those of the 1994 PLY description, and the
/// type names with sizes (int8 .. float64) in addition to the C ones.
[[nodiscard]] Result<PlyHeader, Refusal> read_ply_header(std::string_view bytes);

} // namespace tactus::detail
