// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/abtree/ab_tree.hpp"
#include "rt_core/base/assert.hpp"
#include "rt_core/base/realtime.hpp"
#include "rt_core/forest/edited_surface.hpp"
#include "rt_core/forest/face_pool.hpp"
#include "rt_core/records/changed_face.hpp"
#include "rt_core/spm/page_table.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

/// The vertex forest of one model: its active faces, and the two operations that change them. A
/// split or a merge is a table write over one star; there is no adjacency structure. Each change
/// goes straight to the AB-Tree, whose boxes are right again after its refit().
///
/// The cut is dependency-closed: a record is split only if each fan face is in the state that the
/// record expects, and merged only if each star face is in the state that the record gave it.
/// Otherwise both refuse, with nothing changed.
///
/// Edits remove and add faces. A face in its final state that edits removed is *hidden*: it is
/// active in the forest, but not in the tree. A coarse face near removed ones is *outdated*
/// (ChangedFace). An added face is in forest and tree for as long as it is part of the surface.
///
/// Haptic thread only. Cost: one look-up in the index list and one small write to the tree for each
/// face of the star.
class VertexForest
{
public:
    using ActiveFace = tactus::ActiveFace;

    /// The star of a record that was just split, in the layout of a block: lane i is star[i] of the
    /// record, row 0 is v, row 1 is u, and w0 .. wk follow (VsplitRecord).
    struct StarGeometry
    {
        BlockGeometry geometry;
        std::array<PrimId, kMaxStarFaces> prims{};
    };

    enum class SplitOutcome : std::uint8_t
    {
        done,
        full,         ///< No room for the faces that appear.
        inconsistent, ///< The record contradicts the faces that it names: a fault of the model.
    };

    /// Enters the base mesh of `slots` into the tree, unless there is none (begin() sets it later)
    /// or the arena is measuring. The tree must be empty, of the same owner, and its pool must have
    /// a prim for each face of `faces`. `least` faces are reserved, or as many as are free; the
    /// base mesh must fit. `edits` outlives the forest; null for a model that can't be edited.
    VertexForest(const Arena& arena, FacePool& faces, ModelId owner, std::uint32_t least,
                 const ModelCounts& counts, PageSlots slots, PageTable& pages, AbTree& tree,
                 const EditedSurface* edits = nullptr) noexcept;

    /// Reserves faces in the pool for a forest that has none, neither active nor reserved. False,
    /// with nothing changed, if the pool has no room.
    [[nodiscard]] bool try_promise(std::uint32_t faces) noexcept TACTUS_NONBLOCKING
    {
        return pool_->try_promise(share_, faces);
    }
    /// Ends the reservation of a forest without faces.
    void end_promise() noexcept TACTUS_NONBLOCKING { pool_->end_promise(share_); }
    /// Sets the base mesh of a forest without faces; enter() brings it into the tree.
    void begin(const BaseMesh& base) noexcept TACTUS_NONBLOCKING;
    /// Enters up to `most` more faces of the base mesh and returns how many. Room for all is
    /// reserved.
    [[nodiscard]] std::uint32_t enter(std::uint32_t most) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool has_entered() const noexcept { return entered_ == counts_.base_faces; }
    /// Removes up to `most` faces, refined or not, and returns how many. Before the last one
    /// nothing may be split or merged; after it the pages may be removed.
    [[nodiscard]] std::uint32_t leave(std::uint32_t most) noexcept TACTUS_NONBLOCKING;

    /// Undoes the record's collapse. The record must be linked and not refined, and every record
    /// that it depends on refined (missing_dependency()).
    [[nodiscard]] SplitOutcome split(RecordId id) noexcept
    {
        StarGeometry star;
        return split(id, pages_->resident(id), star);
    }
    /// The same with the record's content at hand; writes `star` if the outcome is `done`.
    [[nodiscard]] SplitOutcome split(RecordId id, const VsplitRecord& record,
                                     StarGeometry& star) noexcept TACTUS_NONBLOCKING;

    /// Redoes the record's collapse. False, with nothing changed, if another record refined a star
    /// face further.
    [[nodiscard]] bool try_merge(RecordId id) noexcept TACTUS_NONBLOCKING;

    /// Makes the faces of an edit go and come, once EditedSurface has taken it. The tree must be
    /// refitted, before it and afterwards.
    void apply(const SurfaceEdit& edit) noexcept TACTUS_NONBLOCKING;
    /// True if a face was hidden or outdated.
    [[nodiscard]] bool has_removed() const noexcept
    {
        return edits_ != nullptr && edits_->has_removed();
    }
    /// True if the prim's face is outdated (ChangedFace).
    [[nodiscard]] bool is_outdated(PrimId prim) const noexcept TACTUS_NONBLOCKING;
    /// True if removed source faces may lie within `reach_m` of a point: the faces that a merge
    /// would leave there may be outdated.
    [[nodiscard]] bool may_be_removed_near(const Vec3f& point_m,
                                           double reach_m) const noexcept TACTUS_NONBLOCKING;

    /// The first record that must be split before this one; none if all are split.
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
    /// The largest error of the faces that would be left after a merge of the record.
    [[nodiscard]] ErrorCode
    error_before(const VsplitRecord& record) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] Vec3f position_of(VertexId vertex) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] std::array<Vec3f, 3> corners_of(PrimId prim) const noexcept TACTUS_NONBLOCKING;

    /// The present face, for AbTree::offer_unplaced(). Its id is none if the prim has no face.
    [[nodiscard]] ChangedFace describe(PrimId prim) const noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] std::uint32_t active_faces() const noexcept { return share_.used; }
    [[nodiscard]] std::uint32_t active_faces_max() const noexcept { return active_max_; }
    /// Capacity of the pool, in faces.
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
        std::uint32_t place{0}; ///< Index of the corner that changes.
    };
    struct Fan
    {
        std::array<FanFace, kMaxFanFaces> faces{};
        VertexId first{}; ///< First ring vertex, w0.
        VertexId last{};  ///< Last ring vertex, wk.
    };

    /// Contribution of a face to the state hash.
    [[nodiscard]] static std::uint64_t hash_of(const ActiveFace& face,
                                               ErrorCode error) noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool find_fan(const VsplitRecord& record, Fan& fan) const noexcept;
    [[nodiscard]] bool find_star(RecordId id, const VsplitRecord& record,
                                 std::array<PrimId, kMaxStarFaces>& star) const noexcept;
    [[nodiscard]] ErrorCode error_in(FaceId face,
                                     FaceState state) const noexcept TACTUS_NONBLOCKING;
    /// Part that a source face has in the surface after edits.
    enum class Standing : std::uint8_t
    {
        shown,
        outdated,
        hidden,
    };
    /// Standing of an active face; of an added one it is `shown`.
    [[nodiscard]] Standing standing_of(const ActiveFace& face, ErrorCode error,
                                       const std::array<Vec3f, 3>& corners_m) const noexcept
    {
        return has_removed() ? standing_after_edits(face, error, corners_m) : Standing::shown;
    }
    [[nodiscard]] Standing
    standing_after_edits(const ActiveFace& face, ErrorCode error,
                         const std::array<Vec3f, 3>& corners_m) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool is_final(const ActiveFace& face) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] bool is_added(FaceId face) const noexcept
    {
        return edits_ != nullptr && edits_->is_added(face);
    }
    [[nodiscard]] float error_m(ErrorCode error) const noexcept;
    /// Number of added faces that may still come.
    [[nodiscard]] std::uint32_t promised_to_edits() const noexcept
    {
        return edits_ == nullptr ? 0U : edits_->room() - edits_->added();
    }
    void outdate_near(const Aabb& removed_m) noexcept TACTUS_NONBLOCKING;
    void outdate_in_block(std::uint32_t block, const Aabb& removed_m) noexcept;
    [[nodiscard]] Vec3f corner_position(PrimId prim,
                                        std::uint32_t place) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] Vec3f
    unplaced_corner_position(PrimId prim, std::uint32_t place) const noexcept TACTUS_NONBLOCKING;
    [[nodiscard]] PrimId add_face(const ActiveFace& face, ErrorCode error, std::uint32_t bucket,
                                  const std::array<Vec3f, 3>& corners_m) noexcept;
    void remove_face(PrimId prim) noexcept;
    void move_corner(FanFace fan, VertexId to, const Vec3f& position_m, FaceState state,
                     ErrorCode error) noexcept;
    void move_corner_after_edits(FanFace fan, const Vec3f& position_m, ErrorCode error) noexcept;

    ModelCounts counts_;
    PageSlots slots_;
    PageTable* pages_;
    AbTree* tree_;
    const EditedSurface* edits_;
    FacePool* pool_;
    std::span<ActiveFace> faces_; ///< Faces of the whole pool.
    std::uint32_t owner_;
    PoolShare share_;
    std::uint32_t entered_{0}; ///< Faces of the base mesh that entered the tree.
    std::uint32_t refined_count_{0};
    std::uint32_t active_max_{0};
    std::uint64_t hash_{0};
};

} // namespace tactus
