// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/id_table.hpp"
#include "rt_core/records/changed_face.hpp"
#include "rt_core/spm/page_table.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

/// The vertex forest of one model: which faces are active now, and the two operations that change
/// that. A split or a merge is a table write over one star; there is no adjacency structure.
///
/// The cut it holds is dependency-closed: a record is split only when each fan face is in the state
/// that the record expects, and merged only when each star face is in the state that the
/// record gave it. Both refuse, with nothing changed, when that does not hold.
///
/// Haptic thread only. Cost: about 8 table look-ups a split or merge.
class VertexForest
{
public:
    /// One active face: 20 B, besides 16 B in the index list.
    struct ActiveFace
    {
        FaceId id{};
        std::array<VertexId, 3> corners{};
        FaceState state;
    };

    enum class SplitOutcome : std::uint8_t
    {
        done,
        full,         ///< No room for the appearing faces.
        inconsistent, ///< The record contradicts the faces it names: a fault of the model.
    };

    /// Memory for at most `face_capacity` active faces, at least the base mesh's, which must be
    /// in `slots.base` already. `change_capacity` bounds changed_faces() between two
    /// clear_changes().
    VertexForest(Arena& arena, const ModelCounts& counts, PageSlots slots, PageTable& pages,
                 std::uint32_t face_capacity, std::uint32_t change_capacity) noexcept;

    /// Undoes the record's collapse. The record is linked and not refined, and every record it
    /// depends on is refined (see missing_dependency()).
    [[nodiscard]] SplitOutcome split(RecordId id) noexcept;

    /// Redoes the record's collapse; false when a star face has been refined further.
    [[nodiscard]] bool try_merge(RecordId id) noexcept;

    /// The first record that must be split before this one; none when there is none.
    [[nodiscard]] RecordId missing_dependency(const VsplitRecord& record) const noexcept;

    [[nodiscard]] const ActiveFace& face(PrimId prim) const noexcept { return faces_[prim.value]; }
    [[nodiscard]] PrimId find(FaceId face) const noexcept { return {index_list_.find(face.value)}; }
    /// kNextExact, kNextPending, or the id of the record that splits the face next.
    [[nodiscard]] std::uint32_t next_of(PrimId prim) const noexcept;
    [[nodiscard]] ErrorCode error_of(PrimId prim) const noexcept;
    [[nodiscard]] Vec3f position_of(VertexId vertex) const noexcept;
    [[nodiscard]] std::array<Vec3f, 3> corners_of(PrimId prim) const noexcept;

    /// Slots changed since clear_changes(), each once, in order of first change.
    [[nodiscard]] std::span<const PrimId> changed_prims() const noexcept
    {
        return changed_.first(changed_count_);
    }
    [[nodiscard]] bool is_changed(PrimId prim) const noexcept
    {
        return change_marks_[prim.value] != 0;
    }
    [[nodiscard]] ChangedFace describe(PrimId prim) const noexcept;
    void clear_changes() noexcept;
    /// Whether one more split or merge could be recorded.
    [[nodiscard]] bool has_room_for_changes() const noexcept
    {
        return changed_.size() - changed_count_ >= kMaxStarFaces;
    }

    [[nodiscard]] std::uint32_t active_faces() const noexcept { return index_list_.size(); }
    [[nodiscard]] std::uint32_t active_faces_max() const noexcept { return active_max_; }
    [[nodiscard]] std::uint32_t capacity() const noexcept
    {
        return static_cast<std::uint32_t>(faces_.size());
    }
    [[nodiscard]] std::uint32_t refined_records() const noexcept { return refined_count_; }

    /// Commutative sum over (face id, error, corners) of the active faces: the same cut has the
    /// same hash however it was reached. Kept up to date by every split and merge.
    [[nodiscard]] std::uint64_t state_hash() const noexcept { return hash_; }

private:
    struct Star
    {
        std::array<PrimId, kMaxFanFaces> fan{};
        VertexId first{}; ///< w0
        VertexId last{};  ///< wk
    };

    [[nodiscard]] bool find_fan(const VsplitRecord& record, Star& star) const noexcept;
    [[nodiscard]] bool star_is_intact(RecordId id, const VsplitRecord& record) const noexcept;
    void add_face(const ActiveFace& face) noexcept;
    void remove_face(FaceId face) noexcept;
    void replace_corner(PrimId prim, VertexId from, VertexId to, FaceState state) noexcept;
    void mark_changed(PrimId prim) noexcept;
    [[nodiscard]] std::uint64_t hash_of(PrimId prim) const noexcept;

    ModelCounts counts_;
    PageSlots slots_;
    PageTable* pages_;
    std::span<ActiveFace> faces_;
    IdTable index_list_;
    std::span<std::uint32_t> free_prims_;
    std::uint32_t free_count_{0};
    std::span<PrimId> changed_;
    std::span<std::uint8_t> change_marks_;
    std::uint32_t changed_count_{0};
    std::uint32_t refined_count_{0};
    std::uint32_t active_max_{0};
    std::uint64_t hash_{0};
};

} // namespace tactus
