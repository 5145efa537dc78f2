// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/forest/face_pool.hpp"
#include "rt_core/records/changed_face.hpp"
#include "rt_core/spm/page_table.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

/// The vertex forest of one model: which of its faces are active now, and the two operations that
/// change that. A split or a merge is a table write over one star; there is no adjacency structure.
/// Each change goes straight to the AB-Tree, whose boxes are right again after its refit().
///
/// The cut it holds is dependency-closed: a record is split only when each fan face is in the state
/// that the record expects, and merged only when each star face is in the state that the
/// record gave it. Both refuse, with nothing changed, when that does not hold.
///
/// Haptic thread only. Cost: one look-up in the index list and one small write to the tree for each
/// face of the star.
class VertexForest
{
public:
    using ActiveFace = tactus::ActiveFace;

    /// The star of a record that was just split, laid out as a block is: lane i is the face at
    /// place i of the star, row 0 is v, row 1 is u, and w0 .. wk follow.
    struct StarGeometry
    {
        BlockGeometry geometry;
        std::array<PrimId, kMaxStarFaces> prims{};
    };

    enum class SplitOutcome : std::uint8_t
    {
        done,
        full,         ///< No room for the appearing faces.
        inconsistent, ///< The record contradicts the faces it names: a fault of the model.
    };

    /// The base mesh must be in `slots.base` already and enters the tree, which is empty and the
    /// same owner's, and whose pool has as many prims as `faces` has faces. `least` of these are
    /// kept for the forest; the base mesh has room. Nothing enters on a `measuring` arena, nor
    /// where `slots` have no base mesh: that comes by begin().
    VertexForest(const Arena& arena, FacePool& faces, ModelId owner, std::uint32_t least,
                 const ModelCounts& counts, PageSlots slots, PageTable& pages,
                 AbTree& tree) noexcept;

    /// Keeps faces in the pool for a forest that has none and had none kept. False, with nothing
    /// changed, where the pool has no room.
    [[nodiscard]] bool try_promise(std::uint32_t faces) noexcept TACTUS_NONBLOCKING
    {
        return pool_->try_promise(share_, faces);
    }
    /// The forest has no face: nothing is kept for it any more.
    void end_promise() noexcept TACTUS_NONBLOCKING { pool_->end_promise(share_); }
    /// The base mesh of a forest without faces: enter() brings it into the tree.
    void begin(const BaseMesh& base) noexcept TACTUS_NONBLOCKING;
    /// Up to `most` more of its faces; returns how many. Room for all is kept.
    [[nodiscard]] std::uint32_t enter(std::uint32_t most) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool has_entered() const noexcept { return entered_ == counts_.base_faces; }
    /// The way back, whatever is refined: takes up to `most` faces out and returns how many. Before
    /// the last one nothing may be split or merged; after it the pages may go.
    [[nodiscard]] std::uint32_t leave(std::uint32_t most) noexcept TACTUS_NONBLOCKING;

    /// Undoes the record's collapse. The record is linked and not refined, and every record it
    /// depends on is refined (see missing_dependency()).
    [[nodiscard]] SplitOutcome split(RecordId id) noexcept
    {
        StarGeometry star;
        return split(id, pages_->resident(id), star);
    }
    /// The same for a record at hand; `star` is written when it is done.
    [[nodiscard]] SplitOutcome split(RecordId id, const VsplitRecord& record,
                                     StarGeometry& star) noexcept TACTUS_NONBLOCKING;

    /// Redoes the record's collapse; false when a star face has been refined further.
    [[nodiscard]] bool try_merge(RecordId id) noexcept TACTUS_NONBLOCKING;

    /// The first record that must be split before this one; none when there is none.
    [[nodiscard]] RecordId
    missing_dependency(const VsplitRecord& record) const noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] const ActiveFace& face(PrimId prim) const noexcept
    {
        TACTUS_ASSERT(prim.value < faces_.size());
        return faces_[prim.value];
    }
    [[nodiscard]] PrimId find(FaceId face) const noexcept { return pool_->find(face, owner_); }
    /// kNextExact, kNextPending, or the id of the record that splits the face next.
    [[nodiscard]] std::uint32_t next_of(PrimId prim) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] ErrorCode error_of(PrimId prim) const noexcept TACTUS_NONBLOCKING;
    /// The largest error of the faces that a merge of the record would leave.
    [[nodiscard]] ErrorCode
    error_before(const VsplitRecord& record) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] Vec3f position_of(VertexId vertex) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] std::array<Vec3f, 3> corners_of(PrimId prim) const noexcept TACTUS_NONBLOCKING;

    /// The face as it is now, for a tree that has no place for it yet.
    [[nodiscard]] ChangedFace describe(PrimId prim) const noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] std::uint32_t active_faces() const noexcept { return share_.used; }
    [[nodiscard]] std::uint32_t active_faces_max() const noexcept { return active_max_; }
    /// Of the pool.
    [[nodiscard]] std::uint32_t capacity() const noexcept { return pool_->capacity(); }
    /// Active faces of all models of the pool.
    [[nodiscard]] std::uint32_t active_in_pool() const noexcept { return pool_->used(); }
    [[nodiscard]] std::uint32_t refined_records() const noexcept { return refined_count_; }

    /// Commutative sum over (face id, error, corners) of the active faces: the same cut has the
    /// same hash however it was reached. Kept up to date by every split and merge.
    [[nodiscard]] std::uint64_t state_hash() const noexcept { return hash_; }

private:
    friend class ForestValidator;

    struct FanFace
    {
        PrimId prim{};
        std::uint32_t place{0}; ///< Of the corner that changes.
    };
    struct Fan
    {
        std::array<FanFace, kMaxFanFaces> faces{};
        VertexId first{}; ///< w0
        VertexId last{};  ///< wk
    };

    /// What a face adds to the state hash.
    [[nodiscard]] static std::uint64_t hash_of(const ActiveFace& face,
                                               ErrorCode error) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool find_fan(const VsplitRecord& record, Fan& fan) const noexcept;
    [[nodiscard]] bool find_star(RecordId id, const VsplitRecord& record,
                                 std::array<PrimId, kMaxStarFaces>& star) const noexcept;
    [[nodiscard]] ErrorCode error_in(FaceId face,
                                     FaceState state) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] Vec3f corner_position(PrimId prim,
                                        std::uint32_t place) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] PrimId add_face(const ActiveFace& face, ErrorCode error, std::uint32_t bucket,
                                  const std::array<Vec3f, 3>& corners_m) noexcept;
    void remove_face(PrimId prim) noexcept;
    void move_corner(FanFace fan, VertexId to, const Vec3f& position_m, FaceState state,
                     ErrorCode error) noexcept;

    ModelCounts counts_;
    PageSlots slots_;
    PageTable* pages_;
    AbTree* tree_;
    FacePool* pool_;
    std::span<ActiveFace> faces_; ///< All of the pool's.
    std::uint32_t owner_;
    PoolShare share_;
    std::uint32_t entered_{0}; ///< Faces of the base mesh that are in, or were split.
    std::uint32_t refined_count_{0};
    std::uint32_t active_max_{0};
    std::uint64_t hash_{0};
};

} // namespace tactus
