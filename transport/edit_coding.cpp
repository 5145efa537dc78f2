// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/base/assert.hpp"
#include "rt_core/base/byte_io.hpp"
#include "transport/edit_content.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <type_traits>

namespace tactus
{

namespace
{

using CodedPoint = std::array<std::uint32_t, 3>;

/// End of the buckets: a face's path has 31 bits for its bucket.
constexpr std::uint32_t kBucketEnd = 1U << 31U;
constexpr std::uint32_t kGridBits = 24;

template <typename T>
void put(std::vector<std::byte>& bytes, T value)
{
    static_assert(std::is_arithmetic_v<T>);
    const auto* first = reinterpret_cast<const std::byte*>(&value);
    bytes.insert(bytes.end(), first, first + sizeof(T));
}

void put_grid(std::vector<std::byte>& bytes, std::uint32_t value)
{
    put(bytes, static_cast<std::uint8_t>(value));
    put(bytes, static_cast<std::uint16_t>(value >> 8U));
}

std::uint32_t read_grid(ByteReader& reader)
{
    const std::uint32_t low = reader.read<std::uint8_t>();
    return low | static_cast<std::uint32_t>(reader.read<std::uint16_t>()) << 8U;
}

CodedPoint on_grid(const Vec3f& corner_m, const ModelHeader& header)
{
    CodedPoint point{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const float quanta = corner_m[axis] / header.quantum_m();
        TACTUS_ASSERT(quanta >= 0.0F);
        TACTUS_ASSERT(quanta < static_cast<float>(1U << kGridBits));
        point[axis] = static_cast<std::uint32_t>(quanta);
        TACTUS_ASSERT(static_cast<float>(point[axis]) == quanta);
    }
    return point;
}

bool has_source_face(std::span<const FaceId> faces, std::uint32_t face_ids)
{
    return std::ranges::any_of(faces, [&](FaceId face) { return face.value < face_ids; });
}

bool has_twice(std::vector<std::uint32_t> numbers)
{
    std::ranges::sort(numbers);
    return std::ranges::adjacent_find(numbers) != numbers.end();
}

Refusal not_an_edit(const std::string& text)
{
    return {"an edit is refused: " + text};
}

/// Reads the removed faces and their box into `edit`; returns a reason to refuse them.
std::optional<Refusal> read_removed(ByteReader& reader, std::uint32_t count,
                                    const ModelHeader& header, EditContent& edit)
{
    const std::uint32_t source_ids = header.counts().face_ids();
    const std::uint32_t end = source_ids + kMaxAddedFaces;
    std::vector<std::uint32_t> ids;
    for (std::uint32_t i = 0; i < count; ++i)
    {
        ids.push_back(reader.read<std::uint32_t>());
        edit.removed.push_back(FaceId{ids.back()});
    }
    if (const auto bad = std::ranges::find_if(ids, [&](std::uint32_t id) { return id >= end; });
        bad != ids.end())
    {
        return not_an_edit(fmt::format("it removes face {}; 0 .. {} are allowed", *bad, end - 1));
    }
    if (!reader.failed() && has_twice(std::move(ids)))
    {
        return not_an_edit("it removes a face twice");
    }
    if (!has_source_face(edit.removed, source_ids))
    {
        return std::nullopt;
    }
    for (Vec3f* corner : {&edit.removed_m.low, &edit.removed_m.high})
    {
        for (float& coordinate : *corner)
        {
            coordinate = reader.read<float>();
        }
    }
    return reader.failed() || is_sound(edit.removed_m)
               ? std::nullopt
               : std::optional(not_an_edit("the box of the removed faces is empty or not finite"));
}

std::optional<Refusal> read_vertices(ByteReader& reader, std::uint32_t count,
                                     const ModelHeader& header, std::vector<Vec3f>& vertices)
{
    for (std::uint32_t i = 0; i < count && !reader.failed(); ++i)
    {
        Vec3f& vertex = vertices.emplace_back();
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const std::uint32_t quanta = read_grid(reader);
            const std::uint32_t most = header.fields().extent_quanta[axis];
            if (quanta > most)
            {
                return not_an_edit(
                    fmt::format("vertex {} is at {} quanta on axis {}; 0 .. {} are allowed", i,
                                quanta, axis, most));
            }
            vertex[axis] = static_cast<float>(quanta) * header.quantum_m();
        }
    }
    return std::nullopt;
}

std::optional<Refusal> read_added(ByteReader& reader, std::uint32_t count,
                                  std::span<const Vec3f> vertices, EditContent& edit)
{
    std::vector<std::uint32_t> slots;
    std::uint32_t used = 0; // Vertices are numbered by their first use.
    for (std::uint32_t i = 0; i < count && !reader.failed(); ++i)
    {
        AddedFace& face = edit.added.emplace_back();
        face.slot = reader.read<std::uint32_t>();
        face.bucket = reader.read<std::uint32_t>();
        if (face.slot >= kMaxAddedFaces || face.bucket >= kBucketEnd)
        {
            return not_an_edit(fmt::format("added face {} has slot {} and bucket {}; 0 .. {} and "
                                           "0 .. {} are allowed",
                                           i, face.slot, face.bucket, kMaxAddedFaces - 1,
                                           kBucketEnd - 1));
        }
        slots.push_back(face.slot);
        for (Vec3f& corner : face.corners_m)
        {
            const std::uint32_t vertex = reader.read<std::uint16_t>();
            if (reader.failed())
            {
                return std::nullopt;
            }
            if (vertex >= vertices.size() || vertex > used)
            {
                return not_an_edit(fmt::format("added face {} has vertex {}; 0 .. {} are allowed",
                                               i, vertex,
                                               std::min<std::size_t>(used, vertices.size() - 1)));
            }
            used += vertex == used ? 1U : 0U;
            corner = vertices[vertex];
        }
    }
    if (reader.failed())
    {
        return std::nullopt;
    }
    if (used != vertices.size())
    {
        return not_an_edit(fmt::format("{} of its {} vertices have no face", vertices.size() - used,
                                       vertices.size()));
    }
    return has_twice(std::move(slots)) ? std::optional(not_an_edit("it adds a slot twice"))
                                       : std::nullopt;
}

} // namespace

void encode_edit(const EditContent& edit, const ModelHeader& header, std::vector<std::byte>& coded)
{
    TACTUS_ASSERT(edit.removed.size() <= kMaxSumFaces);
    TACTUS_ASSERT(edit.added.size() <= kMaxSumFaces);
    std::map<CodedPoint, std::uint16_t> numbers;
    std::vector<CodedPoint> vertices;
    std::vector<std::uint16_t> corners;
    for (const AddedFace& face : edit.added)
    {
        for (const Vec3f& corner_m : face.corners_m)
        {
            const CodedPoint point = on_grid(corner_m, header);
            const auto [known, is_new] =
                numbers.emplace(point, static_cast<std::uint16_t>(vertices.size()));
            corners.push_back(known->second);
            if (is_new)
            {
                vertices.push_back(point);
            }
        }
    }
    coded.clear();
    put(coded, edit.revision);
    put(coded, static_cast<std::uint16_t>(edit.removed.size()));
    put(coded, static_cast<std::uint16_t>(vertices.size()));
    put(coded, static_cast<std::uint16_t>(edit.added.size()));
    for (const FaceId face : edit.removed)
    {
        put(coded, face.value);
    }
    if (has_source_face(edit.removed, header.counts().face_ids()))
    {
        for (const Vec3f& corner : {edit.removed_m.low, edit.removed_m.high})
        {
            std::ranges::for_each(corner, [&](float coordinate) { put(coded, coordinate); });
        }
    }
    for (const CodedPoint& point : vertices)
    {
        std::ranges::for_each(point, [&](std::uint32_t quanta) { put_grid(coded, quanta); });
    }
    for (std::size_t i = 0; i < edit.added.size(); ++i)
    {
        put(coded, edit.added[i].slot);
        put(coded, edit.added[i].bucket);
        for (std::size_t corner = 3 * i; corner < 3 * i + 3; ++corner)
        {
            put(coded, corners[corner]);
        }
    }
}

Result<EditContent, Refusal> decode_edit(std::span<const std::byte> coded,
                                         const ModelHeader& header, std::size_t most)
{
    ByteReader reader(coded);
    EditContent edit;
    edit.revision = reader.read<std::uint32_t>();
    const std::uint32_t removed = reader.read<std::uint16_t>();
    const std::uint32_t corners = reader.read<std::uint16_t>();
    const std::uint32_t added = reader.read<std::uint16_t>();
    if (removed > most || added > most || corners > 3 * added)
    {
        return not_an_edit(fmt::format("it removes {} faces and adds {} with {} vertices; {} faces "
                                       "and three vertices a face are allowed",
                                       removed, added, corners, most));
    }
    std::vector<Vec3f> vertices;
    auto fault = read_removed(reader, removed, header, edit);
    fault = fault ? fault : read_vertices(reader, corners, header, vertices);
    fault = fault ? fault : read_added(reader, added, vertices, edit);
    if (fault)
    {
        return *fault;
    }
    if (reader.failed() || !reader.at_end())
    {
        return not_an_edit(
            fmt::format("its {} bytes are not those that its counts need", coded.size()));
    }
    return edit;
}

} // namespace tactus
