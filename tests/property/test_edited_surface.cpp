// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// What EditedSurface takes and refuses, at none, one, full and over, against sets of the standard
/// library; and the boxes round removed faces.

#include "platform/machine/pool_memory.hpp"
#include "rt_core/forest/edited_surface.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace tactus::test
{

namespace
{

constexpr std::uint32_t kRoom = 40;

class EditedSurfaceTest : public ::testing::Test
{
protected:
    EditedSurfaceTest()
    {
        RigOptions options = with_room_for_all();
        options.edit_faces = kRoom;
        rig_.emplace(small_model(0), options);
        const ModelHeader& header = rig_->model().header;
        face_ids_ = header.counts().face_ids();
        quantum_m_ = header.quantum_m();
        sut_.emplace(arena_, header, kRoom);
    }

    [[nodiscard]] AddedFace face(std::uint32_t slot) const
    {
        const float q = quantum_m_;
        return {slot, 0, {Vec3f{q, q, q}, Vec3f{2 * q, q, q}, Vec3f{q, 2 * q, q}}};
    }
    [[nodiscard]] FaceId id_of(std::uint32_t slot) const { return {face_ids_ + slot}; }
    [[nodiscard]] static Aabb box_at(float x) { return {{x, 0.0F, 0.0F}, {x, 0.0F, 0.0F}}; }

    /// Takes an edit with the next number.
    std::optional<EditRefusal> take(const std::vector<FaceId>& removed,
                                    const std::vector<AddedFace>& added, const Aabb& box = {})
    {
        return sut_->take({ModelId{0}, sut_->revision() + 1, removed, added, box});
    }

    std::optional<FrameRig> rig_;
    std::uint32_t face_ids_{0};
    float quantum_m_{0.0F};
    PoolMemory memory_{std::size_t{1} << 20U};
    Arena arena_{memory_.span()};
    std::optional<EditedSurface> sut_;
};

} // namespace

TEST_F(EditedSurfaceTest, without_room_refuses_every_edit)
{
    EditedSurface none(arena_, rig_->model().header, 0);
    EXPECT_FALSE(none.can_be_edited());
    EXPECT_FALSE(none.is_added(id_of(0)));
    EXPECT_EQ(none.take({ModelId{0}, 1, {}, {}, {}}), EditRefusal::unknown_model);
}

TEST_F(EditedSurfaceTest, fills_and_empties_its_room)
{
    std::vector<AddedFace> all;
    std::vector<FaceId> ids;
    for (std::uint32_t slot = 0; slot < kRoom; ++slot)
    {
        all.push_back(face(slot));
        ids.push_back(id_of(slot));
    }
    EXPECT_EQ(take({}, all), std::nullopt);
    EXPECT_EQ(sut_->added(), kRoom);
    EXPECT_EQ(sut_->added(id_of(kRoom - 1)), all.back());
    EXPECT_FALSE(sut_->has_removed());
    EXPECT_EQ(take({}, {face(0)}), EditRefusal::bad_face) << "the slot is used";
    EXPECT_EQ(take({}, {face(kRoom)}), EditRefusal::bad_face) << "there is no such slot";
    EXPECT_EQ(take({ids[3]}, {face(3)}), std::nullopt) << "a slot is free for the same edit";
    EXPECT_EQ(take(ids, {}), std::nullopt);
    EXPECT_EQ(sut_->added(), 0U);
    EXPECT_EQ(sut_->added_max(), kRoom);
    EXPECT_EQ(sut_->revision(), 3U);
}

TEST_F(EditedSurfaceTest, refuses_what_an_edit_cannot_be_and_keeps_everything)
{
    ASSERT_EQ(take({FaceId{5}}, {face(1)}, box_at(0.0F)), std::nullopt);
    const auto refused = [&](EditRefusal reason, const SurfaceEdit& edit)
    {
        EXPECT_EQ(sut_->take(edit), reason);
        EXPECT_EQ(sut_->revision(), 1U);
        EXPECT_EQ(sut_->added(), 1U);
        EXPECT_TRUE(sut_->is_removed(FaceId{5}));
        EXPECT_FALSE(sut_->is_removed(FaceId{6}));
        EXPECT_FALSE(sut_->is_removed(FaceId{7}));
        EXPECT_EQ(sut_->added(id_of(1)), face(1));
    };
    const std::vector<FaceId> two{FaceId{6}, FaceId{7}};
    const std::vector<FaceId> twice{FaceId{6}, FaceId{7}, FaceId{6}};
    const std::vector<FaceId> gone{FaceId{6}, FaceId{5}};
    const std::vector<FaceId> absent{FaceId{6}, id_of(2)};
    const std::vector<FaceId> beyond{FaceId{6}, id_of(kRoom)};
    const std::vector<FaceId> none{FaceId{6}, FaceId{}};
    const std::vector<FaceId> many(kMaxEditFaces + 1, FaceId{6});
    const std::vector<AddedFace> more(kMaxEditFaces + 1, face(0));
    const Aabb box = box_at(1.0F);
    refused(EditRefusal::wrong_revision, {ModelId{0}, 1, two, {}, box});
    refused(EditRefusal::wrong_revision, {ModelId{0}, 3, two, {}, box});
    refused(EditRefusal::too_large, {ModelId{0}, 2, many, {}, box});
    refused(EditRefusal::too_large, {ModelId{0}, 2, {}, more, {}});
    refused(EditRefusal::bad_face, {ModelId{0}, 2, {}, {}, box}); // No source face is in it.
    for (const auto& removed : {twice, gone, absent, beyond, none})
    {
        refused(EditRefusal::unknown_face, {ModelId{0}, 2, removed, {}, box});
    }
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float q = quantum_m_;
    const auto extent = static_cast<float>(rig_->model().header.fields().extent_quanta[0]);
    std::vector<AddedFace> bad(7, face(2));
    bad[0].corners_m[1][2] = nan;
    bad[1].corners_m[0][0] = -q;
    bad[2].corners_m[0][0] = (extent + 1.0F) * q;
    bad[3].corners_m[2][1] = 1.5F * q;
    bad[4].bucket = 1U << 31U;
    bad[5].slot = kRoom;
    bad[6].slot = 1;
    for (const AddedFace& one : bad)
    {
        const std::vector<AddedFace> added{face(0), one};
        refused(EditRefusal::bad_face, {ModelId{0}, 2, two, added, box});
    }
    for (const Aabb& wrong : {Aabb{}, Aabb{{nan, 0.0F, 0.0F}, {1.0F, 1.0F, 1.0F}},
                              Aabb{{1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 1.0F}}})
    {
        refused(EditRefusal::bad_face, {ModelId{0}, 2, two, {}, wrong});
    }
}

TEST_F(EditedSurfaceTest, keeps_every_removed_place_in_its_boxes)
{
    const std::uint64_t seed = mixed(51, 0);
    std::vector<Aabb> boxes;
    for (std::uint32_t i = 0; i < 4 * kMaxRemovedBoxes; ++i)
    {
        const auto at = static_cast<float>(mixed(seed, i) % 1'000);
        const Aabb box{{at, 0.0F, at}, {at + 1.0F, 1.0F, at}};
        boxes.push_back(box);
        ASSERT_EQ(take({FaceId{i}}, {}, box), std::nullopt);
        for (const Aabb& known : boxes)
        {
            EXPECT_TRUE(sut_->may_be_removed_near(known, 0.0F)) << "seed " << seed << ", " << i;
        }
        if (i < kMaxRemovedBoxes)
        {
            EXPECT_FALSE(sut_->may_be_removed_near(box_at(2'000.0F), 900.0F)) << i;
        }
        EXPECT_TRUE(sut_->may_be_removed_near(box_at(at - 3.0F), 1'004.0F)) << i;
    }
    EXPECT_FALSE(sut_->may_be_removed_near(box_at(-1.0F), 0.5F));
}

} // namespace tactus::test
