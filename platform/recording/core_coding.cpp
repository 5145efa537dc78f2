// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/fixed_writer.hpp"
#include "platform/recording/recording_format.hpp"

#include <cmath>
#include <cstdint>
#include <utility>

namespace tactus
{

namespace
{

enum class CoreKind : std::uint8_t
{
    point = 0,
    segment = 1,
    box = 2,
    hull = 3,
    mesh = 4,
};

constexpr double kLongest_m = 1e6;

void append_vector(std::vector<std::byte>& bytes, const Vec3& value)
{
    append(bytes, value.x());
    append(bytes, value.y());
    append(bytes, value.z());
}

/// Reads a point into `value`; false for NaN and values out of range.
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

std::optional<ToolCore> read_hull(ByteReader& reader, HullVertices& all)
{
    const auto count = reader.read<std::uint8_t>();
    std::vector<Vec3> vertices(count);
    for (Vec3& vertex : vertices)
    {
        if (!read_vector(reader, vertex))
        {
            return std::nullopt;
        }
    }
    all.push_back(std::make_shared<const std::vector<Vec3>>(std::move(vertices)));
    const auto hull = Hull::create(*all.back());
    return hull ? std::optional<ToolCore>(hull.value()) : std::nullopt;
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
    else if (const auto* hull = std::get_if<Hull>(&core))
    {
        append(bytes, static_cast<std::uint8_t>(CoreKind::hull));
        append(bytes, static_cast<std::uint8_t>(hull->vertices().size()));
        for (const Vec3& vertex : hull->vertices())
        {
            append_vector(bytes, vertex);
        }
    }
    else if (const auto* mesh = std::get_if<MeshCore>(&core))
    {
        append(bytes, static_cast<std::uint8_t>(CoreKind::mesh));
        append(bytes, mesh->model.value);
    }
    else
    {
        TACTUS_ASSERT(std::holds_alternative<PointCore>(core));
        append(bytes, static_cast<std::uint8_t>(CoreKind::point));
    }
}

std::optional<ToolCore> read_core(ByteReader& reader, HullVertices& vertices)
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
    case CoreKind::hull:
        return read_hull(reader, vertices);
    case CoreKind::mesh:
    {
        MeshCore mesh;
        mesh.model = ModelId{reader.read<std::uint32_t>()};
        return mesh;
    }
    }
    return std::nullopt;
}

} // namespace tactus
