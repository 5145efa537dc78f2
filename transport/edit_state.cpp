// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "transport/edit_state.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/math/smallest_union.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <utility>

namespace tactus
{

namespace
{

static_assert(kMaxRemovedBoxes < 256); // Type of box_of_edit_.

/// Fills edits up to their limits, in the order of the calls.
class StepPacker
{
public:
    StepPacker(std::uint32_t revision, std::size_t most) : revision_(revision), most_(most) {}

    void add(const AddedFace& face)
    {
        step(steps_.empty() || steps_.back().added.size() == most_).added.push_back(face);
    }
    void remove(FaceId face) { step(is_full_of_removed()).removed.push_back(face); }
    /// Lets one face take the slot of another.
    void replace(FaceId face, const AddedFace& by)
    {
        EditContent& edit = step(is_full_of_removed() || steps_.back().added.size() == most_);
        edit.removed.push_back(face);
        edit.added.push_back(by);
    }
    /// Removes a source face; all those of a box come in a row.
    void remove(FaceId face, std::uint32_t number, const Aabb& box_m)
    {
        EditContent& edit = step(is_full_of_removed() || (box_ != kNone && box_ != number));
        box_ = number;
        edit.removed_m = box_m;
        edit.removed.push_back(face);
    }
    [[nodiscard]] std::vector<EditContent> take() { return std::move(steps_); }

private:
    static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

    [[nodiscard]] bool is_full_of_removed() const
    {
        return steps_.empty() || steps_.back().removed.size() == most_;
    }
    EditContent& step(bool is_new)
    {
        if (is_new)
        {
            steps_.emplace_back().revision = ++revision_;
            box_ = kNone;
        }
        return steps_.back();
    }

    std::uint32_t revision_;
    std::size_t most_;
    std::vector<EditContent> steps_;
    std::uint32_t box_{kNone}; ///< Box of the last step; kNone: it removes no source face.
};

} // namespace

EditState::EditState(const ModelCounts& counts, std::uint32_t room)
    : face_ids_(counts.face_ids()), room_(room)
{
    TACTUS_ASSERT(room <= kMaxAddedFaces);
}

std::optional<Refusal> EditState::fault_of(const EditContent& edit, std::size_t most) const
{
    const auto refuse = [&](const std::string& text)
    { return Refusal{fmt::format("edit {} is refused: {}", edit.revision, text)}; };
    if (edit.revision != revision_ + 1)
    {
        return refuse(fmt::format("the next edit has the number {}", revision_ + 1));
    }
    if (edit.removed.size() > most || edit.added.size() > most)
    {
        return refuse(fmt::format("it removes {} faces and adds {}; at most {} each are allowed",
                                  edit.removed.size(), edit.added.size(), most));
    }
    if (auto fault = fault_of_removed(edit))
    {
        return refuse(fault->text);
    }
    std::set<std::uint32_t> slots;
    for (const AddedFace& face : edit.added)
    {
        if (face.slot >= room_)
        {
            return refuse(fmt::format("it adds a face in slot {}, but the room for added faces is "
                                      "{}",
                                      face.slot, room_));
        }
        const FaceId id{face_ids_ + face.slot};
        const bool is_free = !added_.contains(face.slot) ||
                             std::ranges::find(edit.removed, id) != edit.removed.end();
        if (!is_free || !slots.insert(face.slot).second)
        {
            return refuse(fmt::format("it adds a face in slot {}, which is used", face.slot));
        }
    }
    return std::nullopt;
}

std::optional<Refusal> EditState::fault_of_removed(const EditContent& edit) const
{
    std::set<std::uint32_t> known;
    bool removes_source = false;
    for (const FaceId face : edit.removed)
    {
        const bool is_source = face.value < face_ids_;
        const bool is_there =
            is_source ? !is_removed(face) : added_.contains(face.value - face_ids_);
        if (!is_there || !known.insert(face.value).second)
        {
            return Refusal{
                fmt::format("it removes face {}, which is not part of the surface", face.value)};
        }
        removes_source = removes_source || is_source;
    }
    if (removes_source && !is_sound(edit.removed_m))
    {
        return Refusal{"the box of the removed faces is empty or not finite"};
    }
    return std::nullopt;
}

void EditState::apply(const EditContent& edit)
{
    TACTUS_ASSERT(!fault_of(edit, kMaxSumFaces));
    revision_ = edit.revision;
    const bool removes_source =
        std::ranges::any_of(edit.removed, [&](FaceId face) { return face.value < face_ids_; });
    if (removes_source)
    {
        box_of_edit_.push_back(static_cast<std::uint8_t>(box_for(edit.removed_m)));
    }
    for (const FaceId face : edit.removed)
    {
        if (face.value < face_ids_)
        {
            removed_.emplace(face.value, static_cast<std::uint32_t>(box_of_edit_.size() - 1));
        }
        else
        {
            added_.erase(face.value - face_ids_);
        }
    }
    for (const AddedFace& face : edit.added)
    {
        added_.emplace(face.slot, face);
    }
}

/// Index of a box that holds `box`, after others have become one if there are too many.
std::uint32_t EditState::box_for(const Aabb& box)
{
    const auto known =
        std::ranges::find_if(boxes_, [&](const Aabb& each) { return holds(each, box); });
    if (known != boxes_.end())
    {
        return static_cast<std::uint32_t>(known - boxes_.begin());
    }
    boxes_.push_back(box);
    if (boxes_.size() <= kMaxRemovedBoxes)
    {
        return static_cast<std::uint32_t>(boxes_.size() - 1);
    }
    const auto pair = smallest_union(boxes_);
    const std::size_t first = pair.first; // Lambdas of clang 14 capture no structured binding.
    const std::size_t second = pair.second;
    // The last box takes the place of the second one.
    const std::size_t last = boxes_.size() - 1;
    boxes_[first].add(boxes_[second]);
    boxes_[second] = boxes_[last];
    boxes_.pop_back();
    const auto moved = [&](std::size_t index) {
        return index == second ? first : index == last ? second : index;
    };
    for (std::uint8_t& index : box_of_edit_)
    {
        index = static_cast<std::uint8_t>(moved(index));
    }
    return static_cast<std::uint32_t>(moved(last));
}

bool EditState::is_removed(FaceId source_face) const
{
    return removed_.contains(source_face.value);
}

std::vector<FaceId> EditState::removed() const
{
    std::vector<FaceId> faces;
    for (const auto& [face, edit] : removed_)
    {
        faces.push_back(FaceId{face});
    }
    return faces;
}

bool EditState::is_same_surface(const EditState& other) const
{
    return face_ids_ == other.face_ids_ && added_ == other.added_ &&
           std::ranges::equal(
               removed_, other.removed_, {}, [](const auto& face) { return face.first; },
               [](const auto& face) { return face.first; });
}

bool EditState::leads_to(const EditState& target) const
{
    const bool has_room = target.added_.empty() || target.added_.rbegin()->first < room_;
    return face_ids_ == target.face_ids_ && has_room &&
           std::ranges::all_of(removed_, [&](const auto& face)
                               { return target.removed_.contains(face.first); });
}

std::vector<EditContent> EditState::steps_to(const EditState& target, std::size_t most) const
{
    TACTUS_ASSERT(leads_to(target));
    StepPacker packer(revision_, most);
    const auto id_of = [&](std::uint32_t slot) { return FaceId{face_ids_ + slot}; };
    for (const auto& [slot, face] : target.added_)
    {
        if (!added_.contains(slot))
        {
            packer.add(face);
        }
    }
    for (const auto& [slot, face] : target.added_)
    {
        const auto known = added_.find(slot);
        if (known != added_.end() && known->second != face)
        {
            packer.replace(id_of(slot), face);
        }
    }
    for (const auto& [slot, face] : added_)
    {
        if (!target.added_.contains(slot))
        {
            packer.remove(id_of(slot));
        }
    }
    std::vector<std::vector<FaceId>> by_box(target.boxes_.size());
    for (const auto& [face, edit] : target.removed_)
    {
        if (!removed_.contains(face))
        {
            by_box[target.box_of(edit)].push_back(FaceId{face});
        }
    }
    for (std::uint32_t box = 0; box < by_box.size(); ++box)
    {
        for (const FaceId face : by_box[box])
        {
            packer.remove(face, box, target.boxes_[box]);
        }
    }
    return packer.take();
}

} // namespace tactus
