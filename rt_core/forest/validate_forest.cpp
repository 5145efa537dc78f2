// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/forest/validate_forest.hpp"

#include <algorithm>
#include <bit>

namespace tactus
{

class ForestValidator
{
public:
    explicit ForestValidator(const VertexForest& forest) noexcept : forest_(forest) {}

    [[nodiscard]] Flaw find_flaw() noexcept
    {
        check_free_slots();
        // Records come first: the checks of faces read them.
        for (std::uint32_t slot = 0; slot < forest_.pages_->capacity(); ++slot)
        {
            check_page(slot);
        }
        expect(refined_ == forest_.refined_count_, "forest", refined_,
               "records are refined, but its count differs");
        for (std::uint32_t i = 0; finder_.is_sound() && i < forest_.faces_.size(); ++i)
        {
            check_face(PrimId{i});
        }
        if (finder_.is_sound())
        {
            expect(active_ == expected_, "forest", active_,
                   "faces are active, but the refined records give another number");
            expect(active_ == forest_.active_faces(), "forest", active_,
                   "faces are active, but its count differs");
            expect(hash_ == forest_.hash_, "forest", active_,
                   "faces are active, but its hash differs");
        }
        return finder_.first();
    }

private:
    bool expect(bool holds, const char* thing, std::uint32_t index, const char* what) noexcept
    {
        return finder_.expect(holds, thing, index, what);
    }

    void check_free_slots() noexcept
    {
        std::uint32_t listed = 0;
        const std::uint32_t free = forest_.pool_->capacity() - forest_.pool_->used();
        for (std::uint32_t i = forest_.pool_->first_free_; listed < free; ++listed)
        {
            if (!expect(i < forest_.faces_.size(), "prim", i, "is free and out of range") ||
                !expect(forest_.faces_[i].id.is_none(), "prim", i, "is active and free"))
            {
                return;
            }
            i = forest_.faces_[i].corners[0].value;
        }
        const auto none = static_cast<std::uint32_t>(
            std::ranges::count_if(forest_.faces_, [](const VertexForest::ActiveFace& face)
                                  { return face.id.is_none(); }));
        expect(none == free, "forest", none, "slots hold no face, but the pool's count differs");
        expect(forest_.pool_->index_list_.size() == forest_.pool_->used(), "forest",
               forest_.pool_->index_list_.size(),
               "faces are in its index, but the pool's count differs");
    }

    void check_page(std::uint32_t slot) noexcept
    {
        const PageTable::Meta& meta = forest_.pages_->meta(slot);
        if (!forest_.pages_->is_own(slot))
        {
            return;
        }
        for (std::uint64_t left = meta.refined; left != 0; left &= left - 1)
        {
            const auto place = static_cast<std::uint32_t>(std::countr_zero(left));
            ++refined_;
            check_record({(meta.chunk.value << kRecordsPerChunkLog2) + place},
                         forest_.pages_->slots().pages[slot].records[place]);
        }
    }

    void check_record(RecordId id, const VsplitRecord& record) noexcept
    {
        if (!expect(record.fan_size > 0 && record.fan_size <= kMaxFanFaces, "record", id.value,
                    "has no fan or too large a one"))
        {
            return;
        }
        for (std::uint32_t i = 0; i < record.fan_size; ++i)
        {
            const FaceState before = record.before[i];
            if (before.is_base())
            {
                continue;
            }
            if (expect(forest_.pages_->is_refined(before.record()), "record", id.value,
                       "was split before one that it depends on"))
            {
                expect(forest_.pages_->resident(before.record()).depth < record.depth, "record",
                       id.value, "is no deeper than one that it depends on");
            }
        }
        for (std::uint32_t place = 0; place < record.star_end(); ++place)
        {
            const FaceId face = record.star[place];
            expected_ += place < 2 && !face.is_none() ? 1U : 0U;
            expect(face.is_none() || !forest_.find(face).is_none(), "record", id.value,
                   "is refined, and a face of its star is not active");
        }
    }

    void check_face(PrimId prim) noexcept
    {
        const VertexForest::ActiveFace& face = forest_.faces_[prim.value];
        if (face.id.is_none() || is_of_others(prim, face))
        {
            return;
        }
        ++active_;
        if (forest_.is_added(face.id))
        {
            check_added(prim);
            return;
        }
        if (!expect(face.id.value < forest_.counts_.face_ids(), "prim", prim.value,
                    "holds a face that the model does not have") ||
            !expect(forest_.find(face.id) == prim, "face", face.id.value,
                    "is not found in its slot") ||
            !check_state(face) || !check_corners(face))
        {
            return;
        }
        const ErrorCode error = forest_.error_in(face.id, face.state);
        hash_ += VertexForest::hash_of(face, error);
        check_tree(prim, error);
    }

    /// Checks a face that an edit added: it is in the tree as the edit gave it.
    void check_added(PrimId prim) noexcept
    {
        const VertexForest::ActiveFace& face = forest_.faces_[prim.value];
        const AbTree& tree = *forest_.tree_;
        ++expected_;
        hash_ += VertexForest::hash_of(face, 0);
        const std::uint32_t leaf = tree.leaf_of(prim);
        if (!expect(forest_.find(face.id) == prim, "face", face.id.value,
                    "is not found in its slot") ||
            !expect(tree.face_of(prim) == face.id, "face", face.id.value,
                    "has another name in the tree") ||
            leaf == AbTree::kNoLeaf)
        {
            return;
        }
        expect(block_triangle(tree.block(leaf / kBlockFaces), leaf % kBlockFaces) ==
                   forest_.edits_->added(face.id).corners_m,
               "face", face.id.value, "has another corner in the tree");
    }

    /// True if another model owns the face: the tree knows the owner of a placed face, the index
    /// list that of others.
    [[nodiscard]] bool is_of_others(PrimId prim,
                                    const VertexForest::ActiveFace& face) const noexcept
    {
        const AbTree& tree = *forest_.tree_;
        const std::uint32_t leaf = tree.leaf_of(prim);
        return leaf == AbTree::kNoLeaf ? forest_.find(face.id) != prim
                                       : !tree.is_block_in_use(leaf / kBlockFaces);
    }

    /// Checks that the state's record is refined and gave the face that state.
    bool check_state(const VertexForest::ActiveFace& face) noexcept
    {
        const std::uint32_t id = face.id.value;
        if (face.state.is_base())
        {
            return expect(forest_.counts_.is_base(face.id), "face", id,
                          "is in the base state and not of the base mesh") &&
                   expect(face.corners == forest_.slots_.base.faces[id].corners, "face", id,
                          "is in the base state with other corners");
        }
        const RecordId record = face.state.record();
        if (!expect(forest_.pages_->is_refined(record), "face", id,
                    "is in the state of a record that is not refined"))
        {
            return false;
        }
        const VsplitRecord& changed_by = forest_.pages_->resident(record);
        const VertexId vertex = forest_.counts_.vertex_of(record);
        return expect(face.state.place() < changed_by.star_end() &&
                          changed_by.star[face.state.place()] == face.id,
                      "face", id, "is in a state that its record does not give") &&
               expect(std::ranges::find(face.corners, vertex) != face.corners.end(), "face", id,
                      "lacks the vertex of the record that changed it last");
    }

    /// Checks that each corner is of the base mesh or of a refined record, which is no finer than
    /// the record that changed the face last.
    bool check_corners(const VertexForest::ActiveFace& face) noexcept
    {
        const std::uint32_t finest =
            face.state.is_base() ? 0U : forest_.pages_->resident(face.state.record()).depth;
        return std::ranges::all_of(face.corners, [&](VertexId corner)
                                   { return check_corner(face.id.value, corner, finest); });
    }

    /// Checks one corner of a face; false if its record is not refined.
    bool check_corner(std::uint32_t face, VertexId corner, std::uint32_t finest) noexcept
    {
        if (forest_.counts_.is_base(corner))
        {
            return true;
        }
        if (!expect(corner.value < forest_.counts_.vertices() &&
                        forest_.pages_->is_refined(forest_.counts_.record_of(corner)),
                    "face", face, "has a corner that is not split off"))
        {
            return false;
        }
        expect(forest_.pages_->resident(forest_.counts_.record_of(corner)).depth <= finest, "face",
               face, "has a corner finer than the record that changed it last");
        return true;
    }

    void check_tree(PrimId prim, ErrorCode error) noexcept
    {
        const VertexForest::ActiveFace& face = forest_.faces_[prim.value];
        const AbTree& tree = *forest_.tree_;
        const std::array<Vec3f, 3> known_m{forest_.position_of(face.corners[0]),
                                           forest_.position_of(face.corners[1]),
                                           forest_.position_of(face.corners[2])};
        const VertexForest::Standing standing = forest_.standing_of(face, error, known_m);
        if (standing == VertexForest::Standing::hidden)
        {
            expect(tree.face_of(prim).is_none(), "face", face.id.value,
                   "was removed by an edit and is in the tree");
            return;
        }
        expect(tree.face_of(prim) == face.id, "face", face.id.value,
               "has another name in the tree");
        const std::uint32_t leaf = tree.leaf_of(prim);
        if (leaf == AbTree::kNoLeaf)
        {
            expect(tree.is_unplaced(prim), "face", face.id.value, "is not in the tree");
            return;
        }
        const std::uint32_t lane = leaf % kBlockFaces;
        const std::array<Vec3f, 3> corners_m = block_triangle(tree.block(leaf / kBlockFaces), lane);
        expect(tree.side(leaf / kBlockFaces).errors[lane] == error, "face", face.id.value,
               "has another error in the tree");
        expect(corners_m == known_m, "face", face.id.value, "has another corner in the tree");
        expect(standing == VertexForest::Standing::shown ||
                   (tree.side(leaf / kBlockFaces).outdated >> lane & 1U) != 0,
               "face", face.id.value, "may stand for removed faces and counts as the surface");
    }

    const VertexForest& forest_;
    FlawFinder finder_;
    std::uint32_t refined_{0};
    std::uint32_t active_{0};
    std::uint32_t expected_{forest_.counts_.base_faces}; ///< Number of faces that should be active.
    std::uint64_t hash_{0};
};

Flaw find_flaw(const VertexForest& forest) noexcept
{
    return ForestValidator(forest).find_flaw();
}

} // namespace tactus
