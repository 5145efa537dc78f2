// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/forest/vertex_forest.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/math/rounding.hpp"

#include <algorithm>
#include <bit>

namespace tactus
{

namespace
{

std::uint32_t corner_place(const std::array<VertexId, 3>& corners, VertexId vertex) noexcept
{
    return corners[0] == vertex ? 0U : corners[1] == vertex ? 1U : corners[2] == vertex ? 2U : 3U;
}

static_assert(kMaxStarFaces <= kBlockFaces, "a star is laid out as a block");
static_assert(kMaxFanFaces + 3 <= kBlockVertices);

/// Sets lanes, corners and rows of a record's star: lane 0 is A = (v, u, w0), lane 1 is B = (v, wk,
/// u), and lane 2 + i is the fan face (v, wi, wi+1).
void lay_out(BlockGeometry& star, const VsplitRecord& record) noexcept
{
    star.corners[0].fill(0);
    star.corners[1] = {1, static_cast<std::uint8_t>(2 + record.fan_size), 2, 3, 4, 5, 6, 7};
    star.corners[2] = {2, 1, 3, 4, 5, 6, 7, 8};
    const std::uint32_t fan = ((1U << record.fan_size) - 1U) << 2U;
    star.vertices = static_cast<std::uint16_t>((1U << (3 + record.fan_size)) - 1);
    star.faces = static_cast<std::uint16_t>(fan | (record.has_face(0) ? 1U : 0U) |
                                            (record.has_face(1) ? 2U : 0U));
}

void set_row(BlockGeometry& star, std::uint32_t row, const Vec3f& position_m) noexcept
{
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        star.coordinates[axis][row] = position_m[axis];
    }
}

Aabb box_of(const std::array<Vec3f, 3>& corners_m) noexcept
{
    Aabb box;
    for (const Vec3f& corner : corners_m)
    {
        box.add(corner);
    }
    return box;
}

std::uint32_t position_hash(const Vec3f& position_m) noexcept
{
    std::uint32_t hash = 0;
    for (const float coordinate : position_m)
    {
        hash = (hash ^ std::bit_cast<std::uint32_t>(coordinate)) * 0x9E37'79B9U;
        hash ^= hash >> 15U;
    }
    return hash;
}

std::uint32_t next_corner(std::uint32_t place, std::uint32_t by) noexcept
{
    TACTUS_ASSERT(place < 3);
    return place + by < 3 ? place + by : place + by - 3;
}

} // namespace

VertexForest::VertexForest(const Arena& arena, FacePool& faces, ModelId owner, std::uint32_t least,
                           const ModelCounts& counts, PageSlots slots, PageTable& pages,
                           AbTree& tree, const EditedSurface* edits) noexcept
    : counts_(counts)
    , slots_(slots)
    , pages_(&pages)
    , tree_(&tree)
    , edits_(edits)
    , pool_(&faces)
    , faces_(faces.faces())
    , owner_(owner.value)
    , share_(faces.promise(least))
{
    if (arena.is_measuring() || slots.base.faces.empty())
    {
        return;
    }
    begin(slots.base);
    static_cast<void>(enter(counts.base_faces));
    tree.refit();
}

void VertexForest::begin(const BaseMesh& base) noexcept
{
    TACTUS_ASSERT(base.faces.size() == counts_.base_faces);
    TACTUS_ASSERT(tree_->root().is_none());
    TACTUS_ASSERT(active_faces() == 0);
    TACTUS_ASSERT(pool_->left_for(share_) >= counts_.base_faces);
    TACTUS_ASSERT(tree_->pool().prims().size() >= pool_->capacity());
    slots_.base = base;
    entered_ = 0;
}

std::uint32_t VertexForest::enter(std::uint32_t most) noexcept
{
    const std::uint32_t first = entered_;
    entered_ += std::min(most, counts_.base_faces - entered_);
    for (std::uint32_t i = first; i < entered_; ++i)
    {
        const BaseFace& face = slots_.base.faces[i];
        static_cast<void>(add_face({FaceId{i}, face.corners, FaceState::base()}, face.error,
                                   face.bucket,
                                   {position_of(face.corners[0]), position_of(face.corners[1]),
                                    position_of(face.corners[2])}));
    }
    return entered_ - first;
}

std::uint32_t VertexForest::leave(std::uint32_t most) noexcept
{
    std::uint32_t left = 0;
    for (; left < most && active_faces() > 0; ++left)
    {
        remove_face(tree_->any_prim());
    }
    if (active_faces() == 0)
    {
        TACTUS_ASSERT(hash_ == 0);
        refined_count_ = 0;
        entered_ = 0;
        slots_.base = {};
    }
    return left;
}

/// Hash of a face: odd multipliers spread the ids over the word; the finalizer is SplitMix64's.
std::uint64_t VertexForest::hash_of(const ActiveFace& face, ErrorCode error) noexcept
{
    const std::uint64_t name = (std::uint64_t{face.id.value} << 8U) | error;
    const std::uint64_t edge =
        (std::uint64_t{face.corners[0].value} << 32U) | face.corners[1].value;
    std::uint64_t value = name * 0x9E37'79B9'7F4A'7C15ULL +
                          std::rotl(edge * 0xD6E8'FEB8'6659'FD93ULL, 23) +
                          std::rotl(face.corners[2].value * 0xA076'1D64'78BD'642FULL, 47);
    value = (value ^ (value >> 30U)) * 0xBF58'476D'1CE4'E5B9ULL;
    value = (value ^ (value >> 27U)) * 0x94D0'49BB'1331'11EBULL;
    return value ^ (value >> 31U);
}

VertexForest::SplitOutcome VertexForest::split(RecordId id, const VsplitRecord& record,
                                               StarGeometry& star) noexcept
{
    TACTUS_ASSERT(id.value < counts_.records);
    TACTUS_ASSERT(record.fan_size > 0);
    TACTUS_ASSERT(record.fan_size <= kMaxFanFaces);
    Fan fan;
    if (!find_fan(record, fan))
    {
        return SplitOutcome::inconsistent;
    }
    if (pool_->left_for(share_) < 2 + promised_to_edits())
    {
        return SplitOutcome::full;
    }
    const VertexId vertex = counts_.vertex_of(id);
    const std::uint32_t count = record.fan_size;
    const FanFace& begin = fan.faces[0];
    const FanFace& end = fan.faces[count - 1U];
    lay_out(star.geometry, record);
    set_row(star.geometry, 0, record.position_m);
    set_row(star.geometry, 1, corner_position(begin.prim, begin.place));
    for (std::uint32_t i = 0; i < count; ++i)
    {
        const FanFace& face = fan.faces[i];
        set_row(star.geometry, 2 + i, corner_position(face.prim, next_corner(face.place, 1)));
    }
    set_row(star.geometry, 2 + count, corner_position(end.prim, next_corner(end.place, 2)));
    for (std::uint32_t i = 0; i < count; ++i)
    {
        star.prims[2 + i] = fan.faces[i].prim;
        move_corner(fan.faces[i], vertex, record.position_m, FaceState::after(id, 2 + i),
                    record.error[2 + i]);
    }
    if (record.has_face(0))
    {
        star.prims[0] =
            add_face({record.star[0], {vertex, record.parent, fan.first}, FaceState::after(id, 0)},
                     record.error[0], record.bucket[0], block_triangle(star.geometry, 0));
    }
    if (record.has_face(1))
    {
        star.prims[1] =
            add_face({record.star[1], {vertex, fan.last, record.parent}, FaceState::after(id, 1)},
                     record.error[1], record.bucket[1], block_triangle(star.geometry, 1));
    }
    pages_->set_refined(id, true);
    ++refined_count_;
    return SplitOutcome::done;
}

bool VertexForest::try_merge(RecordId id) noexcept
{
    TACTUS_ASSERT(pages_->is_refined(id));
    const VsplitRecord& record = pages_->resident(id);
    std::array<PrimId, kMaxStarFaces> star{};
    if (!find_star(id, record, star))
    {
        return false;
    }
    // A = (v, u, w0), B = (v, wk, u); a pair contraction has neither.
    const Vec3f parent_at = record.has_face(0)   ? corner_position(star[0], 1)
                            : record.has_face(1) ? corner_position(star[1], 2)
                                                 : position_of(record.parent);
    for (std::uint32_t side = 0; side < 2; ++side)
    {
        if (record.has_face(side))
        {
            remove_face(star[side]);
        }
    }
    const VertexId vertex = counts_.vertex_of(id);
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        const PrimId prim = star[2 + i];
        move_corner({prim, corner_place(faces_[prim.value].corners, vertex)}, record.parent,
                    parent_at, record.before[i], error_in(record.star[2 + i], record.before[i]));
    }
    pages_->set_refined(id, false);
    TACTUS_ASSERT(refined_count_ > 0);
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
    const ActiveFace& active = face(prim);
    TACTUS_ASSERT(!active.id.is_none());
    std::uint32_t& next = active.state.is_base()
                              ? slots_.base.next[active.id.value]
                              : pages_->resident(active.state.record()).next[active.state.place()];
    return load_next(next);
}

ErrorCode VertexForest::error_of(PrimId prim) const noexcept
{
    const std::uint32_t leaf = tree_->leaf_of(prim);
    return leaf != AbTree::kNoLeaf ? tree_->side(leaf / kBlockFaces).errors[leaf % kBlockFaces]
                                   : error_in(faces_[prim.value].id, faces_[prim.value].state);
}

ErrorCode VertexForest::error_before(const VsplitRecord& record) const noexcept
{
    ErrorCode largest = 0;
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        largest = std::max(largest, error_in(record.star[2 + i], record.before[i]));
    }
    return largest;
}

/// Error code stored with the face's state, whether the face is of the base mesh or of a record.
ErrorCode VertexForest::error_in(FaceId face, FaceState state) const noexcept
{
    if (state.is_base())
    {
        return is_added(face) ? ErrorCode{0} : slots_.base.faces[face.value].error;
    }
    return pages_->resident(state.record()).error[state.place()];
}

Vec3f VertexForest::position_of(VertexId vertex) const noexcept
{
    return counts_.is_base(vertex) ? slots_.base.positions_m[vertex.value]
                                   : pages_->resident(counts_.record_of(vertex)).position_m;
}

std::array<Vec3f, 3> VertexForest::corners_of(PrimId prim) const noexcept
{
    return {corner_position(prim, 0), corner_position(prim, 1), corner_position(prim, 2)};
}

/// Position of a corner: from the tree for a placed face, otherwise from the records.
inline Vec3f VertexForest::corner_position(PrimId prim, std::uint32_t place) const noexcept
{
    const std::uint32_t leaf = tree_->leaf_of(prim);
    if (leaf == AbTree::kNoLeaf)
    {
        return unplaced_corner_position(prim, place);
    }
    const BlockGeometry& block = tree_->block(leaf / kBlockFaces);
    const std::size_t row = block.corners[place][leaf % kBlockFaces];
    return {block.coordinates[0][row], block.coordinates[1][row], block.coordinates[2][row]};
}

Vec3f VertexForest::unplaced_corner_position(PrimId prim, std::uint32_t place) const noexcept
{
    const ActiveFace& active = faces_[prim.value];
    return is_added(active.id) ? edits_->added(active.id).corners_m[place]
                               : position_of(active.corners[place]);
}

ChangedFace VertexForest::describe(PrimId prim) const noexcept
{
    ChangedFace change;
    change.prim = prim;
    change.face = face(prim).id;
    if (change.face.is_none())
    {
        return change;
    }
    if (is_added(change.face))
    {
        const AddedFace& added = edits_->added(change.face);
        change.bucket = added.bucket;
        change.corners_m = added.corners_m;
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
    change.is_outdated =
        standing_of(face(prim), change.error, change.corners_m) == Standing::outdated;
    return change;
}

/// Finds the fan faces and the chain w0 .. wk round the record's parent. False if a face is not in
/// the state that the record expects.
bool VertexForest::find_fan(const VsplitRecord& record, Fan& fan) const noexcept
{
    for (std::uint32_t i = 0; i < record.fan_size; ++i)
    {
        const PrimId prim = find(record.star[2 + i]);
        if (prim.is_none() || faces_[prim.value].state != record.before[i])
        {
            return false;
        }
        const std::array<VertexId, 3>& corners = faces_[prim.value].corners;
        const std::uint32_t place = corner_place(corners, record.parent);
        if (place == 3)
        {
            return false;
        }
        const VertexId near = corners[next_corner(place, 1)];
        if (i == 0)
        {
            fan.first = near;
        }
        else if (near != fan.last)
        {
            return false;
        }
        fan.last = corners[next_corner(place, 2)];
        fan.faces[i] = {prim, place};
    }
    return true;
}

/// Finds the faces of the star. False if one is not in the state that the record gave it.
bool VertexForest::find_star(RecordId id, const VsplitRecord& record,
                             std::array<PrimId, kMaxStarFaces>& star) const noexcept
{
    for (std::uint32_t place = 0; place < record.star_end(); ++place)
    {
        if (record.star[place].is_none())
        {
            continue;
        }
        star[place] = find(record.star[place]);
        if (star[place].is_none() || faces_[star[place].value].state != FaceState::after(id, place))
        {
            return false;
        }
    }
    return true;
}

PrimId VertexForest::add_face(const ActiveFace& face, ErrorCode error, std::uint32_t bucket,
                              const std::array<Vec3f, 3>& corners_m) noexcept
{
    const PrimId prim = pool_->take(share_, owner_, face);
    active_max_ = active_faces() > active_max_ ? active_faces() : active_max_;
    hash_ += hash_of(face, error);
    const Standing standing = standing_of(face, error, corners_m);
    if (standing != Standing::hidden)
    {
        tree_->insert({prim, face.id, bucket, error, corners_m, standing == Standing::outdated});
    }
    return prim;
}

void VertexForest::remove_face(PrimId prim) noexcept
{
    hash_ -= hash_of(faces_[prim.value], error_of(prim));
    const bool is_hidden = has_removed() && tree_->face_of(prim).is_none();
    if (!is_hidden)
    {
        tree_->remove(prim);
    }
    pool_->give_back(share_, owner_, prim);
}

inline void VertexForest::move_corner(FanFace fan, VertexId to, const Vec3f& position_m,
                                      FaceState state, ErrorCode error) noexcept
{
    ActiveFace& face = faces_[fan.prim.value];
    hash_ -= hash_of(face, error_of(fan.prim));
    face.corners[fan.place] = to;
    face.state = state;
    hash_ += hash_of(face, error);
    if (has_removed())
    {
        move_corner_after_edits(fan, position_m, error);
    }
    else
    {
        tree_->move_corner(fan.prim, fan.place, position_m, error);
    }
}

/// The same for the tree, in which the face may be hidden or outdated, before or afterwards.
void VertexForest::move_corner_after_edits(FanFace fan, const Vec3f& position_m,
                                           ErrorCode error) noexcept
{
    const ActiveFace& face = faces_[fan.prim.value];
    const bool was_hidden = tree_->face_of(fan.prim).is_none();
    std::array<Vec3f, 3> corners_m = corners_of(fan.prim);
    corners_m[fan.place] = position_m;
    const Standing standing = standing_of(face, error, corners_m);
    if (standing == Standing::hidden)
    {
        if (!was_hidden)
        {
            tree_->remove(fan.prim);
        }
    }
    else if (was_hidden)
    {
        tree_->insert(describe(fan.prim));
    }
    else
    {
        tree_->move_corner(fan.prim, fan.place, position_m, error);
        if (const std::uint32_t leaf = tree_->leaf_of(fan.prim);
            standing == Standing::outdated && leaf != AbTree::kNoLeaf)
        {
            tree_->outdate(leaf / kBlockFaces, 1U << (leaf % kBlockFaces));
        }
    }
}

void VertexForest::apply(const SurfaceEdit& edit) noexcept
{
    TACTUS_ASSERT(edits_ != nullptr);
    // First of all, while the boxes in the tree are those of the last refit.
    outdate_near(edit.removed_m);
    for (const FaceId id : edit.removed)
    {
        const PrimId prim = find(id);
        if (is_added(id))
        {
            remove_face(prim);
        }
        else if (!prim.is_none() && is_final(faces_[prim.value]))
        {
            tree_->remove(prim); // From now on the face is hidden.
        }
    }
    for (const AddedFace& added : edit.added)
    {
        // The corners' hashes serve as vertices, for the hash of the state.
        ActiveFace active{edits_->id_of(added), {}, FaceState::base()};
        for (std::size_t corner = 0; corner < 3; ++corner)
        {
            active.corners[corner] = VertexId{position_hash(added.corners_m[corner])};
        }
        const PrimId prim = pool_->take(share_, owner_, active);
        active_max_ = active_faces() > active_max_ ? active_faces() : active_max_;
        hash_ += hash_of(active, 0);
        tree_->insert({prim, active.id, added.bucket, 0, added.corners_m});
    }
}

/// Marks the coarse faces as outdated that may stand for faces in the box.
void VertexForest::outdate_near(const Aabb& removed_m) noexcept
{
    StaticVector<TreeRef, kTreeStack> stack;
    if (!tree_->root().is_none())
    {
        stack.push_back(tree_->root());
    }
    while (!stack.empty())
    {
        const TreeRef ref = stack.pop_back();
        if (ref.is_block())
        {
            outdate_in_block(ref.index(), removed_m);
            continue;
        }
        const AbNode& node = tree_->node(ref.index());
        for (std::uint32_t children = node.mask; children != 0; children &= children - 1)
        {
            const auto child = static_cast<std::uint32_t>(std::countr_zero(children));
            if (do_meet(node.box_of(child), removed_m))
            {
                stack.push_back(node.children[child]);
            }
        }
    }
}

void VertexForest::outdate_in_block(std::uint32_t block, const Aabb& removed_m) noexcept
{
    std::uint32_t outdated = 0;
    const BlockSide& side = tree_->side(block);
    for (std::uint32_t lanes = tree_->block(block).faces; lanes != 0; lanes &= lanes - 1)
    {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(lanes));
        const ActiveFace& active = faces_[side.prims[lane].value];
        if (!is_added(active.id) && !is_final(active) &&
            do_meet(box_of(block_triangle(tree_->block(block), lane))
                        .inflated(error_m(side.errors[lane])),
                    removed_m))
        {
            outdated |= 1U << lane;
        }
    }
    tree_->outdate(block, outdated);
}

bool VertexForest::is_outdated(PrimId prim) const noexcept
{
    const std::uint32_t leaf = tree_->leaf_of(prim);
    return leaf == AbTree::kNoLeaf
               ? has_removed() && describe(prim).is_outdated
               : (tree_->side(leaf / kBlockFaces).outdated >> (leaf % kBlockFaces) & 1U) != 0;
}

bool VertexForest::may_be_removed_near(const Vec3f& point_m, double reach_m) const noexcept
{
    return has_removed() &&
           edits_->may_be_removed_near({point_m, point_m}, round_up_to_float(reach_m));
}

VertexForest::Standing
VertexForest::standing_after_edits(const ActiveFace& face, ErrorCode error,
                                   const std::array<Vec3f, 3>& corners_m) const noexcept
{
    if (is_added(face.id))
    {
        return Standing::shown;
    }
    if (is_final(face))
    {
        return edits_->is_removed(face.id) ? Standing::hidden : Standing::shown;
    }
    return edits_->may_be_removed_near(box_of(corners_m), error_m(error)) ? Standing::outdated
                                                                          : Standing::shown;
}

/// True if no record changes the source face further.
bool VertexForest::is_final(const ActiveFace& face) const noexcept
{
    std::uint32_t& next = face.state.is_base()
                              ? slots_.base.next[face.id.value]
                              : pages_->resident(face.state.record()).next[face.state.place()];
    return load_next(next) == kNextExact;
}

float VertexForest::error_m(ErrorCode error) const noexcept
{
    return error_in_quanta(error) * tree_->quantum_m();
}

} // namespace tactus
