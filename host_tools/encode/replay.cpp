// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/replay.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus
{

namespace
{

/// Rotates a face so that `first` is its first corner; false if it has no such corner.
bool turn_to(std::array<VertexId, 3>& corners, VertexId first)
{
    const auto at = std::find(corners.begin(), corners.end(), first);
    if (at == corners.end())
    {
        return false;
    }
    std::rotate(corners.begin(), at, corners.end());
    return true;
}

/// Sorts records by a key that contains the record in its low 32 bits.
std::vector<RecordId> sorted_records(std::vector<std::uint64_t> keys)
{
    std::sort(keys.begin(), keys.end());
    std::vector<RecordId> records(keys.size());
    std::transform(keys.begin(), keys.end(), records.begin(),
                   [](std::uint64_t key) { return RecordId{static_cast<std::uint32_t>(key)}; });
    return records;
}

/// Importance by record: the largest error code of its fan before the split, and of its dependents.
std::vector<ErrorCode> importance_of(const DecodedModel& model)
{
    std::vector<ErrorCode> importance(model.header().counts().records, 0);
    const std::vector<RecordId> order = in_dependency_order(model);
    for (auto id = order.rbegin(); id != order.rend(); ++id)
    {
        const VsplitRecord& record = model.record(*id);
        ErrorCode& own = importance[id->value];
        for (std::uint32_t i = 0; i < record.fan_size; ++i)
        {
            own = std::max(own, model.error_of(record.star[2 + i], record.before[i]));
        }
        for (std::uint32_t i = 0; i < record.fan_size; ++i)
        {
            if (!record.before[i].is_base())
            {
                ErrorCode& theirs = importance[record.before[i].record().value];
                theirs = std::max(theirs, own);
            }
        }
    }
    return importance;
}

} // namespace

Replay::Replay(const DecodedModel& model)
    : model_(model)
    , counts_(model.header().counts())
    , faces_(counts_.face_ids())
    , face_count_(counts_.base_faces)
{
    for (std::uint32_t face = 0; face < counts_.base_faces; ++face)
    {
        faces_[face] = {model.base_faces()[face].corners, FaceState::base()};
    }
}

std::optional<std::string> Replay::split(RecordId id)
{
    const VsplitRecord& record = model_.record(id);
    Ring ring;
    if (auto fault = walk_fan(id, ring))
    {
        return fault;
    }
    const VertexId vertex = counts_.vertex_of(id);
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        Face& face = faces_[record.star[2 + i].value];
        std::replace(face.corners.begin(), face.corners.end(), record.parent, vertex);
        face.state = FaceState::after(id, 2 + i);
    }
    if (record.has_face(0))
    {
        faces_[record.star[0].value] = {{vertex, record.parent, ring[0]}, FaceState::after(id, 0)};
        ++face_count_;
    }
    if (record.has_face(1))
    {
        faces_[record.star[1].value] = {{vertex, ring[record.fan_size], record.parent},
                                        FaceState::after(id, 1)};
        ++face_count_;
    }
    return std::nullopt;
}

std::optional<std::string> Replay::walk_fan(RecordId id, Ring& ring) const
{
    const VsplitRecord& record = model_.record(id);
    std::uint32_t depth = 0;
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        const FaceId id_of_face = record.star[2 + i];
        const Face& face = faces_[id_of_face.value];
        std::array<VertexId, 3> corners = face.corners;
        if (!is_active(id_of_face) || face.state != record.before[i])
        {
            return fmt::format("record {}: face {} is not in the expected state", id.value,
                               id_of_face.value);
        }
        if (!turn_to(corners, record.parent) || (i > 0 && corners[1] != ring[i]))
        {
            return fmt::format("record {}: face {} is not the next face round vertex {}", id.value,
                               id_of_face.value, record.parent.value);
        }
        if (model_.error_of(id_of_face, face.state) == 0)
        {
            return fmt::format("record {}: face {} is marked exact before the record", id.value,
                               id_of_face.value);
        }
        ring[i] = corners[1];
        ring[i + 1] = corners[2];
        depth = std::max<std::uint32_t>(depth, depth_of(face.state));
    }
    if (record.depth != depth + 1)
    {
        return fmt::format("record {}: states depth {}, but has depth {}", id.value, record.depth,
                           depth + 1);
    }
    return std::nullopt;
}

std::uint32_t Replay::depth_of(FaceState state) const
{
    return state.is_base() ? 0U : model_.record(state.record()).depth;
}

TriangleMesh Replay::mesh() const
{
    const HeaderFields& fields = model_.header().fields();
    std::vector<std::uint32_t> places(counts_.vertices(), VertexId::kNoneValue);
    for (const Face& face : faces_)
    {
        for (const VertexId corner : face.corners)
        {
            if (!corner.is_none())
            {
                places[corner.value] = 0;
            }
        }
    }
    TriangleMesh mesh;
    for (std::uint32_t vertex = 0; vertex < places.size(); ++vertex)
    {
        if (places[vertex] == 0)
        {
            places[vertex] = static_cast<std::uint32_t>(mesh.positions.size());
            const Vec3f& at_m = model_.position_m({vertex});
            auto& position = mesh.positions.emplace_back(fields.origin_m);
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                position[axis] += static_cast<double>(at_m[axis]);
            }
        }
    }
    mesh.faces.reserve(face_count_);
    for (const Face& face : faces_)
    {
        if (!face.corners[0].is_none())
        {
            mesh.faces.push_back({places[face.corners[0].value], places[face.corners[1].value],
                                  places[face.corners[2].value]});
        }
    }
    return mesh;
}

std::vector<RecordId> in_dependency_order(const DecodedModel& model)
{
    std::vector<std::uint64_t> keys(model.header().counts().records);
    for (std::uint32_t record = 0; record < keys.size(); ++record)
    {
        keys[record] = std::uint64_t{model.record({record}).depth} << 32U | record;
    }
    return sorted_records(std::move(keys));
}

std::vector<RecordId> coarsest_first(const DecodedModel& model)
{
    const std::vector<ErrorCode> importance = importance_of(model);
    std::vector<std::uint64_t> keys(importance.size());
    for (std::uint32_t record = 0; record < keys.size(); ++record)
    {
        const std::uint64_t rank = 255U - importance[record];
        keys[record] = rank << 48U | std::uint64_t{model.record({record}).depth} << 32U | record;
    }
    return sorted_records(std::move(keys));
}

} // namespace tactus
