// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/spm/page_table.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tactus::test
{

namespace
{

constexpr std::uint32_t kPages = 3;

class PageTableTest : public ::testing::Test
{
protected:
    ArenaMemory memory_{1U << 17U};
    Arena arena_{memory_.bytes()};
    PageSlots slots_{PageSlots::take(arena_, {4, 4, 1'000}, kPages, 1)};
    PagePool pool_{arena_, kPages};
    PageTable sut_{pool_, 0, slots_};
};

} // namespace

TEST_F(PageTableTest, an_adopted_page_is_found_until_it_is_evicted)
{
    sut_.adopt({7}, 2, 99);

    EXPECT_EQ(sut_.find({7}), 2U);
    EXPECT_EQ(sut_.used(), 1U);
    EXPECT_EQ(sut_.meta(2).chunk, ChunkId{7});
    EXPECT_EQ(sut_.meta(2).touched, 99U);
    sut_.touch(2, 120);
    EXPECT_EQ(sut_.meta(2).touched, 120U);
    sut_.evict(2);
    EXPECT_EQ(sut_.find({7}), IdTable::kAbsent);
    EXPECT_TRUE(sut_.meta(2).chunk.is_none());
    sut_.adopt({8}, 2, 121);
    EXPECT_EQ(sut_.find({8}), 2U);
    EXPECT_EQ(sut_.find({7}), IdTable::kAbsent);
}

TEST_F(PageTableTest, two_models_have_chunks_of_the_same_numbers_in_slots_of_one_pool)
{
    PageTable other(pool_, kMaxModels - 1, slots_);
    sut_.adopt({7}, 0, 1, 1);
    other.adopt({7}, 1, 2, 2);

    EXPECT_EQ(sut_.find({7}), 0U);
    EXPECT_EQ(other.find({7}), 1U);
    EXPECT_EQ(sut_.used(), 1U);
    EXPECT_EQ(other.used(), 1U);
    EXPECT_TRUE(sut_.is_own(0));
    EXPECT_FALSE(sut_.is_own(1));
    EXPECT_FALSE(sut_.is_own(2));
    other.update_linked({7}, 0, 3); // The other model had that slot once.
    EXPECT_EQ(sut_.meta(0).linked, 1U);
    EXPECT_DEATH(other.evict(0), "");
    sut_.evict(0);
    other.adopt({8}, 0, 3);
    EXPECT_EQ(sut_.find({7}), IdTable::kAbsent);
    EXPECT_EQ(sut_.find({8}), IdTable::kAbsent);
    EXPECT_EQ(other.find({8}), 0U);
    EXPECT_EQ(other.used(), 2U);
}

TEST_F(PageTableTest, only_linked_records_count)
{
    sut_.adopt({7}, 1, 0);
    EXPECT_EQ(sut_.find_linked({7 * 64 + 63}), nullptr);

    sut_.update_linked({7}, 1, std::uint64_t{1} << 63U);

    EXPECT_EQ(sut_.find_linked({7 * 64 + 63}), &slots_.pages[1].records[63]);
    EXPECT_EQ(sut_.find_linked({7 * 64 + 62}), nullptr);
    EXPECT_EQ(&sut_.resident({7 * 64 + 62}), &slots_.pages[1].records[62]);
}

TEST_F(PageTableTest, refined_and_held_are_kept_apart_for_each_record)
{
    sut_.adopt({7}, 1, 0);

    sut_.set_refined({7 * 64}, true);
    sut_.set_refined({7 * 64 + 63}, true);
    sut_.set_held({7 * 64 + 63}, true);

    EXPECT_TRUE(sut_.is_refined({7 * 64}));
    EXPECT_FALSE(sut_.is_refined({7 * 64 + 1}));
    EXPECT_TRUE(sut_.is_held({7 * 64 + 63}));
    EXPECT_FALSE(sut_.is_held({7 * 64}));
    sut_.set_refined({7 * 64}, false);
    EXPECT_FALSE(sut_.is_refined({7 * 64}));
    EXPECT_TRUE(sut_.is_refined({7 * 64 + 63}));
    EXPECT_EQ(sut_.meta(1).refined, std::uint64_t{1} << 63U);
}

namespace
{

constexpr std::uint32_t kShownSlots = 130; // Two words of marks, and a few.

/// Pages of two models that are added, split, merged and removed at random.
class ChangingSlots
{
public:
    explicit ChangingSlots(Random& random) : random_(random) {}

    void change()
    {
        const std::uint32_t slot = random_.below(kShownSlots);
        const PageMeta& meta = pool_.metas[slot];
        if (meta.chunk.is_none())
        {
            const ChunkId chunk{chunks_++}; // Never a resident one.
            tables_[random_.below(2U)].adopt(chunk, slot, 0, ~std::uint64_t{0});
            return;
        }
        PageTable& table = tables_[meta.owner];
        const RecordId record{meta.chunk.value * kRecordsPerChunk + random_.below(64U)};
        if (meta.refined != 0 && random_.one_in(8))
        {
            table.forget_refined(slot);
        }
        else if (meta.refined == 0 && random_.one_in(4))
        {
            table.evict(slot);
        }
        else
        {
            table.set_refined(record, !table.is_refined(record));
        }
    }
    /// Changes that are not visible.
    void use(std::uint32_t frame)
    {
        for (std::uint32_t slot = 0; slot < kShownSlots; ++slot)
        {
            if (!pool_.metas[slot].chunk.is_none())
            {
                tables_[pool_.metas[slot].owner].touch(slot, frame);
            }
        }
    }
    [[nodiscard]] PagePool& pool() { return pool_; }

private:
    Random& random_;
    ArenaMemory memory_{(kShownSlots + 32) * sizeof(Page)};
    Arena arena_{memory_.bytes()};
    PageSlots slots_{PageSlots::take(arena_, {4, 4, 1'000}, kShownSlots, 1)};
    PagePool pool_{arena_, kShownSlots};
    std::array<PageTable, 2> tables_{PageTable(pool_, 0, slots_), PageTable(pool_, 1, slots_)};
    std::uint32_t chunks_{0};
};

} // namespace

TEST(PagePool, a_copy_that_is_brought_up_to_date_now_and_then_is_what_the_slots_are)
{
    Random random(25);
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{64},
                                   std::size_t{100}, std::size_t{128}, std::size_t{kShownSlots}})
    {
        ChangingSlots sut(random);
        std::vector<ShownPage> copy(size);
        for (std::uint32_t round = 0; round < 200; ++round)
        {
            const std::uint32_t changes = random.one_in(10) ? 0 : 1 + random.below(300U);
            for (std::uint32_t i = 0; i < changes; ++i)
            {
                sut.change();
            }
            sut.use(round);
            sut.pool().update_copy(copy);
            const std::vector<ShownPage> whole(sut.pool().metas.begin(), sut.pool().metas.end());
            ASSERT_TRUE(std::equal(copy.begin(), copy.end(), whole.begin()))
                << size << " slots, round " << round;
        }
    }
}

TEST(PagePool, a_slot_that_has_not_changed_is_not_copied_again)
{
    Random random(26);
    ChangingSlots sut(random);
    for (int i = 0; i < 1'000; ++i)
    {
        sut.change();
    }
    std::vector<ShownPage> copy(kShownSlots);
    sut.pool().update_copy(copy);
    const ShownPage strange{ChunkId{77}, 5, 1};
    std::ranges::fill(copy, strange);
    sut.use(1);
    sut.pool().update_copy(copy);
    EXPECT_EQ(std::ranges::count(copy, strange), kShownSlots);
    sut.change();
    sut.pool().update_copy(copy);
    EXPECT_EQ(std::ranges::count(copy, strange), kShownSlots - 1);
}

TEST_F(PageTableTest, misuse_is_a_bug)
{
    sut_.adopt({7}, 1, 0);
    EXPECT_DEATH(sut_.adopt({8}, 1, 0), "") << "a slot in use";
    EXPECT_DEATH(sut_.adopt({7}, 2, 0), "") << "a chunk twice";
    EXPECT_DEATH(sut_.evict(0), "") << "an empty slot";
    EXPECT_DEATH(sut_.set_refined({3}, true), "") << "an absent page";
    EXPECT_DEATH(static_cast<void>(sut_.resident({3})), "");
    sut_.set_refined({7 * 64}, true);
    EXPECT_DEATH(sut_.evict(1), "") << "a pinned page";
    EXPECT_DEATH(sut_.set_refined({7 * 64}, true), "") << "a record that is refined";
    EXPECT_DEATH(sut_.set_refined({7 * 64 + 1}, false), "") << "one that is not";
    EXPECT_DEATH(sut_.set_held({7 * 64 + 1}, true), "") << "one that is not refined";
    sut_.set_held({7 * 64}, true);
    EXPECT_DEATH(sut_.set_refined({7 * 64}, false), "") << "one that is held";
    sut_.update_linked({7}, 1, 3);
    EXPECT_DEATH(sut_.update_linked({7}, 1, 2), "") << "fewer records than before";
    EXPECT_DEATH(sut_.evict(kPages), "") << "no slot";
}

} // namespace tactus::test
