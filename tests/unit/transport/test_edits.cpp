// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/random.hpp"
#include "tests/unit/transport/random_edits.hpp"
#include "tests/unit/transport/tiny_model.hpp"
#include "transport/edit_content.hpp"
#include "transport/edit_state.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace tactus
{
namespace
{

using test::Random;
using test::RandomEdits;

constexpr std::uint32_t kEditRoom = 3'000;

/// Model whose header the edits are coded with.
struct EditedModel
{
    test::TinyModel model = test::make_tiny_model({.records = 4'000});
    ModelHeader header = ModelHeader::parse(model.header).value();
};

const EditedModel& edited_model()
{
    static const EditedModel model;
    return model;
}

std::vector<std::byte> coded(const EditContent& edit)
{
    std::vector<std::byte> bytes;
    encode_edit(edit, edited_model().header, bytes);
    return bytes;
}

/// Expects one clear line with these words.
void expect_refused(const std::vector<std::byte>& bytes, const std::string& words)
{
    const auto decoded = decode_edit(bytes, edited_model().header);
    ASSERT_FALSE(decoded) << words;
    const std::string& text = decoded.error().text;
    EXPECT_NE(text.find(words), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
}

template <typename T>
std::vector<std::byte> with(std::vector<std::byte> bytes, std::size_t at, T value)
{
    std::memcpy(bytes.data() + at, &value, sizeof(value));
    return bytes;
}

/// An edit of one removed source face and two added faces with a common edge.
EditContent small_edit()
{
    const float q = edited_model().header.quantum_m();
    const Vec3f a{0.0F, 0.0F, 0.0F};
    const Vec3f b{q, 0.0F, 0.0F};
    const Vec3f c{0.0F, q, 0.0F};
    const Vec3f d{q, q, 0.0F};
    EditContent edit{1, {FaceId{3}}, {{0, 7, {a, b, c}}, {5, 7, {b, d, c}}}, {}};
    edit.removed_m.add(a);
    edit.removed_m.add(d);
    return edit;
}

// Places in the bytes of small_edit().
constexpr std::size_t kCountsAt = 4;
constexpr std::size_t kRemovedAt = 10;
constexpr std::size_t kBoxAt = kRemovedAt + 4;
constexpr std::size_t kVerticesAt = kBoxAt + 24;
constexpr std::size_t kAddedAt = kVerticesAt + 4 * 9;

TEST(EditCoding, shared_vertices_are_coded_once)
{
    EXPECT_EQ(coded(small_edit()).size(), kAddedAt + 2 * 14);
}

TEST(EditCoding, random_edits_are_decoded_as_they_were)
{
    Random random(1);
    RandomEdits edits(edited_model().header, kEditRoom);
    for (int i = 0; i < 200; ++i)
    {
        const EditContent edit = edits.next(random);
        const auto bytes = coded(edit);
        EXPECT_LE(bytes.size(), kMaxCodedEditBytes);
        const auto decoded = decode_edit(bytes, edited_model().header);
        ASSERT_TRUE(decoded) << decoded.error().text;
        EXPECT_EQ(decoded.value(), edit) << "edit " << i;
    }
}

TEST(EditCoding, the_largest_edit_has_the_stated_size)
{
    const float q = edited_model().header.quantum_m();
    EditContent edit{1, {}, {}, {}};
    edit.removed_m.add(Vec3f{});
    for (std::uint32_t i = 0; i < kMaxSumFaces; ++i)
    {
        edit.removed.push_back(FaceId{i});
        AddedFace face{i, i, {}};
        for (std::uint32_t corner = 0; corner < 3; ++corner)
        {
            const std::uint32_t number = 3 * i + corner;
            face.corners_m[corner] = {static_cast<float>(number % 100) * q,
                                      static_cast<float>(number / 100) * q, 0.0F};
        }
        edit.added.push_back(face);
    }
    const auto bytes = coded(edit);
    EXPECT_EQ(bytes.size(), kMaxCodedEditBytes);
    const auto decoded = decode_edit(bytes, edited_model().header, kMaxSumFaces);
    ASSERT_TRUE(decoded) << decoded.error().text;
    EXPECT_EQ(decoded.value(), edit);
    EXPECT_FALSE(decode_edit(bytes, edited_model().header)); // Only parts of a sum are as large.
}

TEST(EditCoding, every_truncation_and_a_byte_too_many_is_refused)
{
    const auto whole = coded(small_edit());
    ASSERT_TRUE(decode_edit(whole, edited_model().header));
    for (std::size_t size = 0; size < whole.size(); ++size)
    {
        const std::vector<std::byte> cut(whole.begin(),
                                         whole.begin() + static_cast<std::ptrdiff_t>(size));
        EXPECT_FALSE(decode_edit(cut, edited_model().header)) << size;
    }
    auto longer = whole;
    longer.push_back(std::byte{0});
    expect_refused(longer, "bytes are not those");
}

TEST(EditCoding, every_range_is_checked)
{
    const auto whole = coded(small_edit());
    const std::uint32_t face_ids = edited_model().header.counts().face_ids();
    expect_refused(with(whole, kCountsAt, std::uint16_t{kMaxEditFaces + 1}), "faces");
    expect_refused(with(whole, kCountsAt + 4, std::uint16_t{kMaxEditFaces + 1}), "faces");
    expect_refused(with(whole, kCountsAt + 2, std::uint16_t{7}), "three vertices a face");
    expect_refused(with(whole, kRemovedAt, face_ids + kMaxAddedFaces), "removes face");
    expect_refused(with(whole, kBoxAt, std::numeric_limits<float>::quiet_NaN()), "box");
    expect_refused(with(whole, kBoxAt, 1e9F), "box");
    expect_refused(with(whole, kBoxAt + 12, std::numeric_limits<float>::infinity()), "box");
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const std::uint32_t beyond = edited_model().header.fields().extent_quanta[axis] + 1;
        auto far = with(whole, kVerticesAt + 3 * axis, static_cast<std::uint16_t>(beyond));
        far = with(far, kVerticesAt + 3 * axis + 2, static_cast<std::uint8_t>(beyond >> 16U));
        expect_refused(far, "quanta on axis");
    }
    expect_refused(with(whole, kAddedAt, kMaxAddedFaces), "slot");
    expect_refused(with(whole, kAddedAt + 4, 1U << 31U), "bucket");
    expect_refused(with(whole, kAddedAt + 8, std::uint16_t{1}), "vertex");
    expect_refused(with(whole, kAddedAt + 14 + 8, std::uint16_t{4}), "vertex");
    expect_refused(with(whole, kAddedAt + 14 + 10, std::uint16_t{0}), "have no face");
    expect_refused(with(whole, kAddedAt + 14, 0U), "adds a slot twice");
    EditContent twice = small_edit();
    twice.removed.push_back(twice.removed.front());
    expect_refused(coded(twice), "removes a face twice");
}

TEST(EditCoding, a_box_is_only_coded_with_a_source_face)
{
    EditContent edit = small_edit();
    edit.removed = {FaceId{edited_model().header.counts().face_ids() + 2}};
    const auto decoded = decode_edit(coded(edit), edited_model().header);
    ASSERT_TRUE(decoded) << decoded.error().text;
    EXPECT_EQ(decoded.value().removed_m, Aabb{});
}

EditState empty_state(std::uint32_t room = kEditRoom)
{
    return {edited_model().header.counts(), room};
}

TEST(EditState, refuses_what_a_frame_refuses_and_stays_as_it_was)
{
    const std::uint32_t face_ids = edited_model().header.counts().face_ids();
    EditState sut = empty_state(10);
    sut.apply(small_edit());
    EditContent next = small_edit();
    next.revision = 2;
    next.removed = {FaceId{4}};
    next.added = {{1, 0, {}}};
    ASSERT_FALSE(sut.fault_of(next));
    const auto expect_fault = [&](EditContent edit, const std::string& words)
    {
        const auto fault = sut.fault_of(edit);
        ASSERT_TRUE(fault) << words;
        EXPECT_NE(fault->text.find(words), std::string::npos) << fault->text;
    };
    const auto changed = [&](auto change)
    {
        EditContent edit = next;
        change(edit);
        return edit;
    };
    for (const std::uint32_t wrong : {0U, 1U, 3U})
    {
        expect_fault(changed([&](EditContent& edit) { edit.revision = wrong; }), "number 2");
    }
    expect_fault(changed([](EditContent& edit) { edit.removed.resize(kMaxEditFaces + 1); }),
                 "at most 48");
    expect_fault(changed([](EditContent& edit) { edit.added.resize(kMaxEditFaces + 1); }),
                 "at most 48");
    // Removed before, never there, in a free slot, and twice.
    for (const std::uint32_t gone : {3U, face_ids + 1, face_ids + 10, ~0U})
    {
        expect_fault(changed([&](EditContent& edit) { edit.removed = {FaceId{gone}}; }),
                     "not part of the surface");
    }
    expect_fault(changed(
                     [](EditContent& edit) {
                         edit.removed = {FaceId{4}, FaceId{4}};
                     }),
                 "not part of the surface");
    expect_fault(changed([](EditContent& edit) { edit.removed_m = {}; }), "box");
    expect_fault(changed([](EditContent& edit) { edit.added[0].slot = 10; }), "room");
    expect_fault(changed([](EditContent& edit) { edit.added[0].slot = 5; }), "is used");
    expect_fault(changed([](EditContent& edit) { edit.added.push_back(edit.added[0]); }),
                 "is used");
    EXPECT_EQ(sut.revision(), 1U);
    EXPECT_EQ(sut.added().size(), 2U);
    // The same edit may free a slot and use it again.
    const EditContent reuse = changed(
        [&](EditContent& edit)
        {
            edit.removed = {FaceId{face_ids + 5}};
            edit.added[0].slot = 5;
        });
    ASSERT_FALSE(sut.fault_of(reuse));
    sut.apply(reuse);
    EXPECT_EQ(sut.added().at(5), reuse.added[0]);
    EXPECT_EQ(sut.revision(), 2U);
}

/// Surface as sets, changed by edits without any of EditState's code.
struct NaiveSurface
{
    std::set<std::uint32_t> removed;
    std::map<std::uint32_t, std::array<Vec3f, 3>> added;

    void apply(const EditContent& edit, std::uint32_t face_ids)
    {
        for (const FaceId face : edit.removed)
        {
            if (face.value >= face_ids)
            {
                ASSERT_EQ(added.erase(face.value - face_ids), 1U);
            }
            else
            {
                ASSERT_TRUE(removed.insert(face.value).second);
            }
        }
        for (const AddedFace& face : edit.added)
        {
            ASSERT_TRUE(added.emplace(face.slot, face.corners_m).second);
        }
    }
    bool operator==(const NaiveSurface&) const = default;
};

TEST(EditState, is_the_sum_of_random_edits)
{
    Random random(2);
    RandomEdits edits(edited_model().header, kEditRoom);
    const std::uint32_t face_ids = edited_model().header.counts().face_ids();
    NaiveSurface naive;
    EditState sut = empty_state();
    std::map<std::uint32_t, Aabb> boxes; // Box of each removed face's edit.
    for (int i = 0; i < 300; ++i)
    {
        const EditContent edit = edits.next(random);
        ASSERT_FALSE(sut.fault_of(edit)) << sut.fault_of(edit)->text;
        sut.apply(edit);
        naive.apply(edit, face_ids);
        for (const FaceId face : edit.removed)
        {
            boxes.emplace(face.value, edit.removed_m);
        }
    }
    EXPECT_EQ(sut.revision(), 300U);
    EXPECT_EQ(sut.removed_count(), naive.removed.size());
    for (const FaceId face : sut.removed())
    {
        EXPECT_TRUE(naive.removed.contains(face.value));
    }
    ASSERT_EQ(sut.added().size(), naive.added.size());
    for (const auto& [slot, face] : sut.added())
    {
        EXPECT_EQ(naive.added.at(slot), face.corners_m);
    }
    EXPECT_LE(sut.boxes().size(), kMaxRemovedBoxes);
    // The steps from nothing name boxes that hold each face.
    for (const EditContent& step : empty_state().steps_to(sut))
    {
        for (const FaceId face : step.removed)
        {
            Aabb both = step.removed_m;
            both.add(boxes.at(face.value));
            EXPECT_EQ(both, step.removed_m);
        }
    }
}

TEST(EditState, steps_lead_from_any_state_to_any_later_one)
{
    Random random(3);
    const std::uint32_t face_ids = edited_model().header.counts().face_ids();
    for (int round = 0; round < 60; ++round)
    {
        SCOPED_TRACE("round " + std::to_string(round));
        // Two states of one history, or two that share only their removed source faces' order.
        RandomEdits edits(edited_model().header, kEditRoom);
        EditState from = empty_state();
        EditState target = empty_state();
        NaiveSurface naive;
        NaiveSurface wanted;
        const std::uint32_t first = random.below(12U);
        const std::uint32_t all = first + random.below(25U);
        for (std::uint32_t i = 0; i < all; ++i)
        {
            const EditContent edit = edits.next(random);
            target.apply(edit);
            wanted.apply(edit, face_ids);
            if (i < first)
            {
                from.apply(edit);
                naive.apply(edit, face_ids);
            }
        }
        ASSERT_TRUE(from.leads_to(target));
        const auto steps = from.steps_to(target);
        std::size_t last_come = 0;
        std::size_t first_gone = steps.size();
        for (std::size_t i = 0; i < steps.size(); ++i)
        {
            ASSERT_FALSE(from.fault_of(steps[i])) << from.fault_of(steps[i])->text;
            EXPECT_FALSE(steps[i].removed.empty() && steps[i].added.empty());
            // Faces that come in free slots do so before any face goes for good.
            for (const AddedFace& face : steps[i].added)
            {
                last_come = from.added().contains(face.slot) ? last_come : i;
            }
            for (const FaceId face : steps[i].removed)
            {
                const bool is_replaced =
                    face.value >= face_ids && target.added().contains(face.value - face_ids);
                first_gone = is_replaced ? first_gone : std::min(first_gone, i);
            }
            from.apply(steps[i]);
            naive.apply(steps[i], face_ids);
        }
        EXPECT_GE(first_gone, last_come);
        EXPECT_EQ(naive, wanted);
        EXPECT_TRUE(from.is_same_surface(target));
        EXPECT_TRUE(from.steps_to(target).empty());
    }
}

TEST(EditState, no_step_leads_back_to_a_removed_source_face_or_beyond_the_room)
{
    EditState sut = empty_state();
    sut.apply(small_edit());
    EXPECT_FALSE(sut.leads_to(empty_state()));
    EXPECT_TRUE(empty_state().leads_to(sut));
    EXPECT_TRUE(empty_state(6).leads_to(sut));
    EXPECT_FALSE(empty_state(5).leads_to(sut)); // Slot 5 is used.
}

} // namespace
} // namespace tactus
