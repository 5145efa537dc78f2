// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/base/id_table.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <unordered_map>

namespace tactus::test
{

namespace
{

/// Id whose mixed bits are `mixed`, for collisions and ids at the table's end.
std::uint32_t id_mixed_to(std::uint32_t mixed)
{
    std::uint32_t inverse = 0x9E37'79B9U; // Newton's iteration doubles the right bits.
    for (int i = 0; i < 5; ++i)
    {
        inverse *= 2U - 0x9E37'79B9U * inverse;
    }
    return mixed * inverse;
}

class IdTableTest : public ::testing::Test
{
protected:
    IdTable make(std::uint32_t capacity)
    {
        Arena arena(memory_.bytes());
        return IdTable(arena, capacity);
    }

    ArenaMemory memory_{1U << 16U};
};

void expect_same(const IdTable& sut,
                 const std::unordered_map<std::uint32_t, std::uint32_t>& expected,
                 std::span<const std::uint32_t> ids)
{
    ASSERT_EQ(sut.size(), expected.size());
    for (const std::uint32_t id : ids)
    {
        const auto found = expected.find(id);
        ASSERT_EQ(sut.find(id), found == expected.end() ? IdTable::kAbsent : found->second) << id;
    }
}

} // namespace

TEST_F(IdTableTest, random_operations_match_a_map)
{
    Random random(1);
    for (const std::uint32_t capacity : {1U, 2U, 3U, 7U, 64U, 100U})
    {
        IdTable sut = make(capacity);
        std::unordered_map<std::uint32_t, std::uint32_t> expected;
        std::vector<std::uint32_t> ids;
        for (std::uint32_t i = 0; i < 3 * capacity; ++i)
        {
            // One third each: random, all in the first slot, all in the last.
            ids.push_back(i % 3 == 0   ? static_cast<std::uint32_t>(random.bits() >> 33U)
                          : i % 3 == 1 ? id_mixed_to(i)
                                       : id_mixed_to(0xFFFF'FFFFU - i));
        }
        for (int step = 0; step < 1'000; ++step)
        {
            const std::uint32_t id = ids[random.below(static_cast<std::uint32_t>(ids.size()))];
            if (expected.count(id) != 0)
            {
                sut.erase(id);
                expected.erase(id);
            }
            else
            {
                const bool has_room = expected.size() < capacity;
                const std::uint32_t value = random.below(1'000);
                ASSERT_EQ(sut.try_insert(id, value), has_room);
                if (has_room)
                {
                    expected[id] = value;
                }
            }
            ASSERT_NO_FATAL_FAILURE(expect_same(sut, expected, ids)) << capacity << " " << step;
        }
    }
}

TEST_F(IdTableTest, misuse_is_a_bug)
{
    IdTable sut = make(2);
    ASSERT_TRUE(sut.try_insert(1, 1));

    EXPECT_DEATH(static_cast<void>(sut.try_insert(1, 2)), "");
    EXPECT_DEATH(static_cast<void>(sut.try_insert(IdTable::kAbsent, 2)), "");
    EXPECT_DEATH(sut.erase(2), "");
    EXPECT_DEATH(static_cast<void>(make(0)), "");
}

} // namespace tactus::test
