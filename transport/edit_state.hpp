// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/limits.hpp"
#include "rt_core/spm/ids.hpp"
#include "transport/base/refusal.hpp"
#include "transport/edit_content.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

// Any thread except the haptic one: the calls allocate.
namespace tactus
{

/// Surface of a model after edits: the source faces that were removed, and the added faces that are
/// there. It is the sum of all edits so far.
///
/// Each removed source face belongs to a box that holds it. With more than kMaxRemovedBoxes boxes,
/// the two whose union is smallest become one.
class EditState
{
public:
    /// `room` is the number of slots for added faces, at most kMaxAddedFaces (asserted).
    EditState(const ModelCounts& counts, std::uint32_t room);

    /// Reason why the edit can't follow; none if it can. The rules are those of a frame, except
    /// that corners are not checked (decode_edit() does).
    /// At most `most` faces may come, and as many go.
    [[nodiscard]] std::optional<Refusal> fault_of(const EditContent& edit,
                                                  std::size_t most = kMaxEditFaces) const;
    /// Applies an edit without a fault (asserted), with at most kMaxSumFaces faces of a kind.
    void apply(const EditContent& edit);

    [[nodiscard]] std::uint32_t revision() const noexcept { return revision_; }
    [[nodiscard]] std::uint32_t room() const noexcept { return room_; }
    [[nodiscard]] bool is_removed(FaceId source_face) const;
    [[nodiscard]] std::size_t removed_count() const noexcept { return removed_.size(); }
    /// Removed source faces, ascending.
    [[nodiscard]] std::vector<FaceId> removed() const;
    /// Added faces that are there, by slot.
    [[nodiscard]] const std::map<std::uint32_t, AddedFace>& added() const noexcept
    {
        return added_;
    }
    /// Boxes of the removed source faces.
    [[nodiscard]] const std::vector<Aabb>& boxes() const noexcept { return boxes_; }
    /// True if both have the same surface; revisions and boxes don't matter.
    [[nodiscard]] bool is_same_surface(const EditState& other) const;

    /// True if edits can lead from here to `target`: no edit returns a removed source face, and
    /// `target` needs no more slots than there are here.
    [[nodiscard]] bool leads_to(const EditState& target) const;
    /// Edits that lead from here to `target`, which must be possible (asserted). Their revisions
    /// follow revision(). Each has at most `most` faces that come and go, and removes source faces
    /// of one box. Faces come before others go, so that no surface is missing in between.
    /// Only a face that takes the slot of another one comes in the edit in which that one goes.
    [[nodiscard]] std::vector<EditContent> steps_to(const EditState& target,
                                                    std::size_t most = kMaxEditFaces) const;

private:
    [[nodiscard]] std::optional<Refusal> fault_of_removed(const EditContent& edit) const;
    [[nodiscard]] std::uint32_t box_for(const Aabb& box);
    [[nodiscard]] std::uint32_t box_of(std::uint32_t edit) const { return box_of_edit_[edit]; }

    std::uint32_t face_ids_;
    std::uint32_t room_;
    std::uint32_t revision_{0};
    /// Removed source faces, with the index in box_of_edit_ of the edit that removed each.
    std::map<std::uint32_t, std::uint32_t> removed_;
    std::map<std::uint32_t, AddedFace> added_;
    std::vector<Aabb> boxes_;
    /// Index in boxes_ for each edit that removed source faces.
    std::vector<std::uint8_t> box_of_edit_;
};

} // namespace tactus
