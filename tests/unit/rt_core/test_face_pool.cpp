// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/forest/face_pool.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <optional>

namespace tactus::test
{

namespace
{

class FacePoolTest : public ::testing::Test
{
protected:
    void make(std::uint32_t capacity)
    {
        Arena arena(memory_.bytes());
        sut_.emplace(arena, capacity);
    }
    PrimId take(PoolShare& share, std::uint32_t owner, std::uint32_t face)
    {
        ActiveFace taken;
        taken.id = {face};
        taken.corners = {VertexId{owner}, VertexId{face}, VertexId{0}};
        return sut_->take(share, owner, taken);
    }

    ArenaMemory memory_{1U << 16U};
    std::optional<FacePool> sut_;
};

} // namespace

TEST_F(FacePoolTest, a_full_one_has_no_room_until_a_face_goes_back)
{
    make(1);
    PoolShare share = sut_->promise(0);
    const PrimId prim = take(share, 0, 7);

    EXPECT_EQ(sut_->find({7}, 0), prim);
    EXPECT_EQ(sut_->faces()[prim.value].id, FaceId{7});
    EXPECT_EQ(sut_->left_for(share), 0U);
    EXPECT_DEATH(take(share, 0, 8), "");
    sut_->give_back(share, 0, prim);
    EXPECT_TRUE(sut_->find({7}, 0).is_none());
    EXPECT_DEATH(sut_->give_back(share, 0, prim), "");
    EXPECT_EQ(take(share, 0, 8), prim);
}

TEST_F(FacePoolTest, random_changes_of_several_owners_match_a_map)
{
    constexpr std::uint32_t kOwners = 5;
    make(64);
    Random random(2);
    std::array<PoolShare, kOwners> shares;
    shares.fill(sut_->promise(4));
    for (std::uint32_t owner = 1; owner < kOwners; ++owner)
    {
        shares[owner] = sut_->promise(4);
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, PrimId> expected;
    for (int step = 0; step < 5'000; ++step)
    {
        const std::uint32_t owner = random.below(kOwners);
        const std::uint32_t face = random.below(40);
        if (const auto found = expected.find({owner, face}); found != expected.end())
        {
            sut_->give_back(shares[owner], owner, found->second);
            expected.erase(found);
        }
        else if (sut_->left_for(shares[owner]) > 0)
        {
            expected[{owner, face}] = take(shares[owner], owner, face);
        }
        const std::pair key{random.below(kOwners), random.below(40)};
        const auto known = expected.find(key);
        ASSERT_EQ(sut_->find({key.second}, key.first),
                  known == expected.end() ? PrimId{} : known->second);
        ASSERT_EQ(sut_->used(), expected.size());
    }
}

static_assert(kMaxPoolFaces <= IdTable::kAbsent >> 8U,
              "an owner's number has room beside a face's");

} // namespace tactus::test
