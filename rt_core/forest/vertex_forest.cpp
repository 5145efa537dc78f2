// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/forest/vertex_forest.hpp"

namespace tactus
{

namespace
{

/// Finalizer of a 64-bit mixing function (SplitMix64 constants).
std::uint64_t mix(std::uint64_t value) noexcept
{
    value = (value ^ (value >> 30U)) * 0xBF58'476D'1CE4'E5B9ULL;
    value = (value ^ (value >> 27U)) * 0x94D0'49BB'1331'11EBULL;
    return value ^ (value >> 31U);
}

std::uint32_t corner_place(const std::array<VertexId, 3>& corners, VertexId vertex) noexcept
{
    for (std::uint32_t place = 0; place < 3; ++place)
    {
        if (corners[place] == vertex)
        {
            return place;
        }
    }
    return 3;
}

} // namespace

VertexForest::VertexForest(Arena& arena, const ModelCounts& counts, PageSlots slots,
                           PageTable& pages, std::uint32_t face_capacity,
                           std::uint32_t change_capacity) noexcept
    : counts_(counts)
    , slots_(slots)
    , pages_(&pages)
    , faces_(arena.take<ActiveFace>(face_capacity))
    , index_list_(arena, face_capacity)
    , free_prims_(arena.take<std::uint32_t>(face_capacity))
    , changed_(arena.take<PrimId>(change_capacity))
    , change_marks_(arena.take<std::uint8_t>(face_capacity))
{
    if (arena.is_measuring())
    {
        return;
    }
    TACTUS_ASSERT(face_capacity >= counts.base_faces && change_capacity >= counts.base_faces);
    for (std::uint32_t i = 0; i < face_capacity; ++i)
    {
        free_prims_[free_count_++] = face_capacity - 1 - i;
    }
    for (std::uint32_t i = 0; i < counts.base_faces; ++i)
    {
        add_face({FaceId{i}, slots_.base.faces[i].corners, FaceState::base()});
    }
}

VertexForest::SplitOutcome VertexForest::split(RecordId id) noexcept
{
    const VsplitRecord& record = pages_->resident(id);
    TACTUS_ASSERT(has_room_for_changes());
    Star star;
    if (!find_fan(record, star))
    {
        return SplitOutcome::inconsistent;
    }
    if (free_count_ < 2)
    {
        return SplitOutcome::full;
    }
    const VertexId vertex = counts_.vertex_of(id);
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        replace_corner(star.fan[i], record.parent, vertex, FaceState::after(id, 2 + i));
    }
    pages_->set_refined(id, true); // The new faces' errors are read through the record.
    ++refined_count_;
    if (record.has_face(0))
    {
        add_face({record.star[0], {vertex, record.parent, star.first}, FaceState::after(id, 0)});
    }
    if (record.has_face(1))
    {
        add_face({record.star[1], {vertex, star.last, record.parent}, FaceState::after(id, 1)});
    }
    return SplitOutcome::done;
}

bool VertexForest::try_merge(RecordId id) noexcept
{
    const VsplitRecord& record = pages_->resident(id);
    TACTUS_ASSERT(has_room_for_changes());
    if (!star_is_intact(id, record))
    {
        return false;
    }
    for (std::uint32_t side = 0; side < 2; ++side)
    {
        if (record.has_face(side))
        {
            remove_face(record.star[side]);
        }
    }
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        replace_corner(find(record.star[2 + i]), counts_.vertex_of(id), record.parent,
                       record.before[i]);
    }
    pages_->set_refined(id, false);
    --refined_count_;
    return true;
}

RecordId VertexForest::missing_dependency(const VsplitRecord& record) const noexcept
{
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        const FaceState state = record.before[i];
        if (!state.is_base() && !pages_->is_refined(state.record()))
        {
            return state.record();
        }
    }
    return {};
}

std::uint32_t VertexForest::next_of(PrimId prim) const noexcept
{
    const ActiveFace& active = faces_[prim.value];
    std::uint32_t& next = active.state.is_base()
                              ? slots_.base.next[active.id.value]
                              : pages_->resident(active.state.record()).next[active.state.place()];
    return load_next(next);
}

ErrorCode VertexForest::error_of(PrimId prim) const noexcept
{
    const ActiveFace& active = faces_[prim.value];
    return active.state.is_base()
               ? slots_.base.faces[active.id.value].error
               : pages_->resident(active.state.record()).error[active.state.place()];
}

Vec3f VertexForest::position_of(VertexId vertex) const noexcept
{
    return counts_.is_base(vertex) ? slots_.base.positions_m[vertex.value]
                                   : pages_->resident(counts_.record_of(vertex)).position_m;
}

std::array<Vec3f, 3> VertexForest::corners_of(PrimId prim) const noexcept
{
    const std::array<VertexId, 3>& corners = faces_[prim.value].corners;
    return {position_of(corners[0]), position_of(corners[1]), position_of(corners[2])};
}

ChangedFace VertexForest::describe(PrimId prim) const noexcept
{
    ChangedFace change;
    change.prim = prim;
    change.face = faces_[prim.value].id;
    if (change.face.is_none())
    {
        return change;
    }
    if (counts_.is_base(change.face))
    {
        change.bucket = slots_.base.faces[change.face.value].bucket;
    }
    else
    {
        // The record that made the face appear is refined as long as the face is active.
        const std::uint32_t index = change.face.value - counts_.base_faces;
        change.bucket = pages_->resident({index / 2}).bucket[index % 2];
    }
    change.error = error_of(prim);
    change.corners_m = corners_of(prim);
    return change;
}

void VertexForest::clear_changes() noexcept
{
    for (const PrimId prim : changed_prims())
    {
        change_marks_[prim.value] = 0;
    }
    changed_count_ = 0;
}

/// Finds the fan faces in the states the record expects and the chain w0 .. wk round its parent.
bool VertexForest::find_fan(const VsplitRecord& record, Star& star) const noexcept
{
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        star.fan[i] = find(record.star[2 + i]);
        if (star.fan[i].is_none() || faces_[star.fan[i].value].state != record.before[i])
        {
            return false;
        }
        const std::array<VertexId, 3>& corners = faces_[star.fan[i].value].corners;
        const std::uint32_t place = corner_place(corners, record.parent);
        if (place == 3)
        {
            return false;
        }
        const VertexId near = corners[(place + 1) % 3];
        if (i == 0)
        {
            star.first = near;
        }
        else if (near != star.last)
        {
            return false;
        }
        star.last = corners[(place + 2) % 3];
    }
    return true;
}

bool VertexForest::star_is_intact(RecordId id, const VsplitRecord& record) const noexcept
{
    for (std::uint32_t place = 0; place < record.star_end(); ++place)
    {
        if (record.star[place].is_none())
        {
            continue;
        }
        const PrimId prim = find(record.star[place]);
        if (prim.is_none() || faces_[prim.value].state != FaceState::after(id, place))
        {
            return false;
        }
    }
    return true;
}

void VertexForest::add_face(const ActiveFace& face) noexcept
{
    TACTUS_ASSERT(free_count_ > 0);
    const PrimId prim{free_prims_[--free_count_]};
    faces_[prim.value] = face;
    const bool inserted = index_list_.try_insert(face.id.value, prim.value);
    TACTUS_ASSERT(inserted);
    active_max_ = active_faces() > active_max_ ? active_faces() : active_max_;
    hash_ += hash_of(prim);
    mark_changed(prim);
}

void VertexForest::remove_face(FaceId face) noexcept
{
    const PrimId prim = find(face);
    hash_ -= hash_of(prim);
    index_list_.erase(face.value);
    faces_[prim.value] = ActiveFace{};
    free_prims_[free_count_++] = prim.value;
    mark_changed(prim);
}

void VertexForest::replace_corner(PrimId prim, VertexId from, VertexId to, FaceState state) noexcept
{
    ActiveFace& active = faces_[prim.value];
    hash_ -= hash_of(prim);
    const std::uint32_t place = corner_place(active.corners, from);
    TACTUS_ASSERT(place < 3);
    active.corners[place] = to;
    active.state = state;
    hash_ += hash_of(prim);
    mark_changed(prim);
}

void VertexForest::mark_changed(PrimId prim) noexcept
{
    if (change_marks_[prim.value] == 0)
    {
        change_marks_[prim.value] = 1;
        changed_[changed_count_++] = prim;
    }
}

std::uint64_t VertexForest::hash_of(PrimId prim) const noexcept
{
    const ActiveFace& active = faces_[prim.value];
    std::uint64_t value = mix((std::uint64_t{active.id.value} << 8U) | error_of(prim));
    for (const VertexId corner : active.corners)
    {
        value = mix(value + corner.value);
    }
    return value;
}

} // namespace tactus
