// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/base/arena.hpp"
#include "tests/unit/rt_core/support.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>

namespace tactus::test
{

namespace
{

struct Odd
{
    std::array<std::uint8_t, 3> bytes{7, 8, 9};
};

struct alignas(64) Line
{
    std::uint32_t value{42};
};

std::size_t take_some(Arena& arena, std::size_t count)
{
    const auto odds = arena.take<Odd>(count);
    const auto lines = arena.take<Line>(count / 2);
    const auto numbers = arena.take<std::uint64_t>(count * 3);
    return odds.size() + lines.size() + numbers.size();
}

bool is_aligned(const void* address)
{
    return reinterpret_cast<std::uintptr_t>(address) % Arena::kAlignment == 0;
}

} // namespace

TEST(Arena, measuring_counts_exactly_what_is_used_later)
{
    for (std::size_t count = 0; count < 70; ++count)
    {
        Arena measure = Arena::measuring();
        const std::size_t measured_items = take_some(measure, count);
        ArenaMemory memory(measure.used());
        Arena sut(memory.bytes().first(measure.used()));

        const std::size_t items = take_some(sut, count);

        EXPECT_EQ(sut.used(), measure.used()) << count;
        EXPECT_EQ(items, measured_items) << count;
        EXPECT_EQ(sut.left(), 0U) << count;
    }
}

TEST(Arena, a_measuring_arena_gives_sizes_without_memory)
{
    Arena sut = Arena::measuring();

    const auto taken = sut.take<Odd>(5);

    EXPECT_TRUE(sut.is_measuring());
    EXPECT_EQ(taken.size(), 5U);
    EXPECT_EQ(taken.data(), nullptr);
    EXPECT_EQ(sut.left(), 0U);
    EXPECT_EQ(sut.used(), 64U);
}

TEST(Arena, every_part_starts_on_a_line_of_its_own_and_is_constructed)
{
    ArenaMemory memory(4096);
    std::fill(memory.bytes().begin(), memory.bytes().end(), std::byte{0xEE});
    Arena sut(memory.bytes());

    const auto odds = sut.take<Odd>(3);
    const auto lines = sut.take<Line>(2);
    const auto numbers = sut.take<std::uint32_t>(1);

    EXPECT_TRUE(is_aligned(odds.data()));
    EXPECT_TRUE(is_aligned(lines.data()));
    EXPECT_TRUE(is_aligned(numbers.data()));
    EXPECT_EQ(odds[2].bytes[1], 8);
    EXPECT_EQ(lines[1].value, 42U);
    EXPECT_EQ(numbers[0], 0U);
    EXPECT_GE(reinterpret_cast<std::byte*>(lines.data()),
              reinterpret_cast<std::byte*>(odds.data() + odds.size()));
    EXPECT_EQ(sut.used() + sut.left(), memory.bytes().size());
}

TEST(Arena, taking_nothing_uses_nothing)
{
    ArenaMemory memory(64);
    Arena sut(memory.bytes());

    EXPECT_TRUE(sut.take<std::uint64_t>(0).empty());
    EXPECT_EQ(sut.used(), 0U);
}

TEST(ArenaDeathTest, taking_one_byte_too_many_is_a_bug)
{
    ArenaMemory memory(128);
    Arena sut(memory.bytes().first(128));
    static_cast<void>(sut.take<std::uint8_t>(128));

    EXPECT_DEATH(static_cast<void>(sut.take<std::uint8_t>(1)), "");
}

TEST(ArenaDeathTest, memory_off_its_boundary_is_a_bug)
{
    ArenaMemory memory(128);

    EXPECT_DEATH(Arena(memory.bytes().subspan(8)), "");
}

} // namespace tactus::test
