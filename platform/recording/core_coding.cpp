// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/core_coding.hpp"

#include "platform/recording/byte_append.hpp"

#include <cmath>
#include <cstdint>

namespace tactus
{

namespace
{

enum class CoreKind : std::uint8_t
{
    point = 0,
    segment = 1,
    box = 2,
};

constexpr double kLongest_m = 1e6;

void append_vector(std::vector<std::byte>& bytes, const Vec3& value)
{
    append(bytes, value.x());
    append(bytes, value.y());
    append(bytes, value.z());
}

/// Reads a point into `value`; false for NaN and what is too far.
bool read_vector(ByteReader& reader, Vec3& value)
{
    bool is_sound = true;
    for (int axis = 0; axis < 3; ++axis)
    {
        value[axis] = reader.read<double>();
        is_sound = is_sound && std::abs(value[axis]) <= kLongest_m;
    }
    return is_sound;
}

} // namespace

void append_core(std::vector<std::byte>& bytes, const ToolCore& core)
{
    if (const auto* segment = std::get_if<Segment>(&core))
    {
        append(bytes, static_cast<std::uint8_t>(CoreKind::segment));
        append_vector(bytes, segment->from);
        append_vector(bytes, segment->to);
    }
    else if (const auto* box = std::get_if<Box>(&core))
    {
        append(bytes, static_cast<std::uint8_t>(CoreKind::box));
        append_vector(bytes, box->half);
    }
    else
    {
        append(bytes, static_cast<std::uint8_t>(CoreKind::point));
    }
}

std::optional<ToolCore> read_core(ByteReader& reader)
{
    switch (static_cast<CoreKind>(reader.read<std::uint8_t>()))
    {
    case CoreKind::point:
        return PointCore{};
    case CoreKind::segment:
    {
        Segment segment;
        const bool is_sound = read_vector(reader, segment.from) && read_vector(reader, segment.to);
        return is_sound ? std::optional<ToolCore>(segment) : std::nullopt;
    }
    case CoreKind::box:
    {
        Box box;
        const bool is_sound = read_vector(reader, box.half) && (box.half.array() >= 0.0).all();
        return is_sound ? std::optional<ToolCore>(box) : std::nullopt;
    }
    }
    return std::nullopt;
}

} // namespace tactus
