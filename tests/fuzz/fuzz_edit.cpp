// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
/// The input is a sequence of coded edits of one model; bytes past the end are 0. The first byte
/// chooses the room for added faces. Each edit is
///
///     control   1 byte: bit 0 writes the revision that follows, bit 1 takes a copy of the state
///               before it
///     size      2 bytes, little-endian
///     bytes     the coded edit
///
/// A surface of sets follows the accepted edits. At the end, steps lead to the same surface from
/// the start and from the copy.
#include "rt_core/limits.hpp"
#include "tests/fuzz/input_parts.hpp"
#include "tests/fuzz/law.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/edit_content.hpp"
#include "transport/edit_state.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace tactus::fuzz
{

namespace
{

constexpr std::array<std::uint32_t, 4> kRooms{0, 8, 300, kMaxAddedFaces};

const ModelHeader& edited_header()
{
    static const test::TinyModel model = test::make_tiny_model({});
    static const ModelHeader header = ModelHeader::parse(model.header).value();
    return header;
}

bool is_inside(const Aabb& inner, const Aabb& outer)
{
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        if (inner.low[axis] < outer.low[axis] || inner.high[axis] > outer.high[axis])
        {
            return false;
        }
    }
    return true;
}

void check_ranges(const EditContent& edit)
{
    const ModelHeader& header = edited_header();
    const std::uint32_t face_ids = header.counts().face_ids();
    require(edit.removed.size() <= kMaxEditFaces && edit.added.size() <= kMaxEditFaces,
            "an accepted edit has at most the stated number of faces");
    std::set<std::uint32_t> removed;
    bool removes_source = false;
    for (const FaceId face : edit.removed)
    {
        require(face.value < face_ids + kMaxAddedFaces && removed.insert(face.value).second,
                "an accepted edit removes faces that can be, each once");
        removes_source = removes_source || face.value < face_ids;
    }
    require(!removes_source || is_sound(edit.removed_m), "removed source faces have a box");
    std::set<std::uint32_t> slots;
    for (const AddedFace& face : edit.added)
    {
        require(face.slot < kMaxAddedFaces && face.bucket < 1U << 31U &&
                    slots.insert(face.slot).second,
                "an accepted edit adds faces in slots that can be, each once");
        for (const Vec3f& corner_m : face.corners_m)
        {
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                const double quanta =
                    static_cast<double>(corner_m[axis]) / static_cast<double>(header.quantum_m());
                require(quanta >= 0.0 && quanta <= header.fields().extent_quanta[axis] &&
                            quanta == static_cast<std::uint32_t>(quanta),
                        "an accepted corner is on the grid, in the model's box");
            }
        }
    }
}

/// A decoded edit is coded and decoded to the same content, and then coded to the same bytes.
void check_coding(const EditContent& edit)
{
    std::vector<std::byte> coded;
    encode_edit(edit, edited_header(), coded);
    require(coded.size() <= kMaxCodedEditBytes, "a coded edit has at most the stated size");
    const auto again = decode_edit(coded, edited_header());
    require(static_cast<bool>(again), "a coded edit can be decoded");
    require(again.value() == edit, "a decoded edit is coded with its content");
    std::vector<std::byte> second;
    encode_edit(again.value(), edited_header(), second);
    require(second == coded, "an edit is coded to the same bytes again");
}

/// Surface as sets, changed without EditState's code.
struct PlainSurface
{
    std::map<std::uint32_t, Aabb> removed; ///< Boxes of the edits by removed source face.
    std::map<std::uint32_t, AddedFace> added;

    void apply(const EditContent& edit)
    {
        const std::uint32_t face_ids = edited_header().counts().face_ids();
        for (const FaceId face : edit.removed)
        {
            require(face.value < face_ids ? removed.emplace(face.value, edit.removed_m).second
                                          : added.erase(face.value - face_ids) == 1,
                    "an edit without a fault removes faces that are there");
        }
        for (const AddedFace& face : edit.added)
        {
            require(added.emplace(face.slot, face).second,
                    "an edit without a fault adds faces in free slots");
        }
    }
};

void check_state(const EditState& state, const PlainSurface& plain, std::uint32_t revision)
{
    require(state.revision() == revision, "each applied edit is counted");
    require(state.removed_count() == plain.removed.size() && state.added() == plain.added,
            "the state has the faces of its edits");
    for (const FaceId face : state.removed())
    {
        require(plain.removed.contains(face.value) && state.is_removed(face),
                "the state has the removed faces of its edits");
    }
    require(plain.added.empty() || plain.added.rbegin()->first < state.room(),
            "added faces are in the room");
    require(state.boxes().size() <= kMaxRemovedBoxes, "boxes are bounded");
    require(std::ranges::all_of(state.boxes(), [](const Aabb& box) { return is_sound(box); }),
            "boxes are sound");
}

void check_steps(EditState from, const EditState& target, const PlainSurface& plain)
{
    require(from.leads_to(target), "an earlier state leads to a later one");
    const std::uint32_t face_ids = edited_header().counts().face_ids();
    for (const EditContent& step : from.steps_to(target))
    {
        require(!step.removed.empty() || !step.added.empty(), "no step is empty");
        require(!from.fault_of(step), "each step can follow the one before");
        check_ranges(step);
        check_coding(step);
        for (const FaceId face : step.removed)
        {
            require(face.value >= face_ids ||
                        is_inside(plain.removed.at(face.value), step.removed_m),
                    "the box of a step holds those of its removed source faces");
        }
        from.apply(step);
    }
    require(from.is_same_surface(target), "the steps lead to the surface");
    require(from.steps_to(target).empty(), "no step leads to the same surface");
}

/// A state, and what every edit of the input makes of it.
class EditedModel
{
public:
    explicit EditedModel(std::uint32_t room)
        : start_(edited_header().counts(), room), state_(start_), copy_(start_)
    {
    }

    void take(std::vector<std::byte> bytes, unsigned control)
    {
        if ((control & 2U) != 0)
        {
            copy_ = state_;
        }
        const std::uint32_t next = state_.revision() + 1;
        if ((control & 1U) != 0 && bytes.size() >= sizeof(next))
        {
            std::memcpy(bytes.data(), &next, sizeof(next));
        }
        const auto edit = decode_edit(bytes, edited_header());
        if (!edit)
        {
            require(is_one_clear_line(edit.error().text), "a refused edit is one clear line");
            return;
        }
        check_ranges(edit.value());
        check_coding(edit.value());
        if (const auto fault = state_.fault_of(edit.value()))
        {
            require(is_one_clear_line(fault->text), "an edit's fault is one clear line");
            return;
        }
        require(edit.value().revision == next, "only the next edit can follow");
        state_.apply(edit.value());
        plain_.apply(edit.value());
        check_state(state_, plain_, next);
        ++accepted_inputs;
    }

    void end() const
    {
        check_steps(start_, state_, plain_);
        check_steps(copy_, state_, plain_);
    }

private:
    EditState start_;
    EditState state_;
    EditState copy_;
    PlainSurface plain_;
};

} // namespace

} // namespace tactus::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace tactus;
    fuzz::InputParts input(data, size);
    fuzz::EditedModel model(fuzz::kRooms.at(input.byte() % fuzz::kRooms.size()));
    while (!input.is_at_end())
    {
        fuzz::InputParts::Part part = input.part();
        model.take(std::move(part.bytes), part.control);
    }
    model.end();
    return 0;
}
