// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/spm/index_page.hpp"
#include "tests/unit/rt_core/coded_bytes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace tactus::test
{

namespace
{

constexpr ModelCounts kCounts{4, 4, 64 * 64 + 3 * 64};
constexpr IndexPageId kLastPage{1};

struct Entry
{
    InfluenceBox box{{1, 2, 3}, {4, 5, 6}};
    std::uint16_t coded_bytes{500};
    std::uint8_t hash{0};
};

/// Second index page, with three chunks.
std::vector<std::byte> write_page(std::uint32_t number, std::span<const Entry> entries)
{
    CodedBytes bytes;
    bytes.put(number);
    for (const Entry& entry : entries)
    {
        bytes.put(entry.box).put(entry.coded_bytes);
        for (int i = 0; i < 16; ++i)
        {
            bytes.put(entry.hash);
        }
    }
    return bytes.with_checksum();
}

std::array<Entry, 3> sound_entries()
{
    std::array<Entry, 3> entries;
    entries[1].box = {{0, 0, 0}, {65'535, 0, 1}};
    entries[1].coded_bytes = kMaxCodedChunkBytes;
    entries[2].coded_bytes = 1;
    entries[2].hash = 0xAB;
    return entries;
}

class IndexPageTest : public ::testing::Test
{
protected:
    Result<Done, SpmRefusal> parse(std::span<const std::byte> bytes)
    {
        return parse_index_page(bytes, kCounts, kLastPage, page_, entries_);
    }

    IndexPage page_;
    std::array<ChunkEntry, kChunksPerIndexPage> entries_;
};

} // namespace

TEST_F(IndexPageTest, a_sound_page_gives_its_entries_back)
{
    const auto bytes = write_page(1, sound_entries());

    ASSERT_TRUE(parse(bytes).has_value());

    EXPECT_EQ(bytes.size(), coded_index_page_bytes(3));
    EXPECT_EQ(page_.chunks, 3U);
    EXPECT_EQ(page_.box(0).low, (std::array<std::uint16_t, 3>{1, 2, 3}));
    EXPECT_EQ(page_.box(1).high, (std::array<std::uint16_t, 3>{65'535, 0, 1}));
    EXPECT_EQ(entries_[1].coded_bytes, kMaxCodedChunkBytes);
    EXPECT_EQ(entries_[2].hash[15], 0xAB);
}

TEST_F(IndexPageTest, another_pages_bytes_are_refused)
{
    EXPECT_EQ(parse(write_page(0, sound_entries())).error(), SpmRefusal::wrong_identity);
}

TEST_F(IndexPageTest, a_box_inside_out_or_an_impossible_size_is_refused)
{
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        auto entries = sound_entries();
        entries[2].box.low[axis] = 7;
        EXPECT_EQ(parse(write_page(1, entries)).error(), SpmRefusal::value_out_of_range);
    }
    auto entries = sound_entries();
    entries[0].coded_bytes = 0;
    EXPECT_EQ(parse(write_page(1, entries)).error(), SpmRefusal::value_out_of_range);
    entries[0].coded_bytes = kMaxCodedChunkBytes + 1;
    EXPECT_EQ(parse(write_page(1, entries)).error(), SpmRefusal::value_out_of_range);
}

/// Gap in doubles, which are exact enough.
double gap_of(const QuantumBox& page, const InfluenceBox& box, const QuantumSphere& sphere)
{
    double sum = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const double step = index_step(page.low[axis], page.high[axis]);
        const double low = page.low[axis] + step * box.low[axis];
        const double high = page.low[axis] + step * box.high[axis];
        const double gap = std::max({low - sphere.center[axis], sphere.center[axis] - high, 0.0});
        sum += gap * gap;
    }
    return std::sqrt(sum);
}

TEST(IndexBoxes, meet_the_spheres_that_come_to_them)
{
    std::mt19937_64 random(7); // NOLINT: the same every time.
    const auto below = [&](std::int64_t end)
    { return static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(end)); };
    std::uint32_t met = 0;
    std::uint32_t missed = 0;
    for (int round = 0; round < 2'000; ++round)
    {
        QuantumBox page_box;
        IndexPage page;
        page.chunks = static_cast<std::uint32_t>(1 + below(kChunksPerIndexPage));
        const std::int64_t side = std::int64_t{1} << (1 + below(24));
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            page_box.low[axis] = static_cast<std::int32_t>(below(1 << 24) - (1 << 23));
            page_box.high[axis] = page_box.low[axis] + static_cast<std::int32_t>(below(side));
        }
        for (std::uint32_t i = 0; i < page.chunks; ++i)
        {
            InfluenceBox box;
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                const std::int64_t at = below(65'536);
                box.low[axis] = static_cast<std::uint16_t>(at);
                box.high[axis] = static_cast<std::uint16_t>(at + below(65'536 - at) / 16);
            }
            page.set_box(i, box);
        }
        QuantumSphere sphere;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            sphere.center[axis] = static_cast<double>(page_box.low[axis]) +
                                  0.001 * static_cast<double>(below(1'500 * side) - 250 * side);
        }
        sphere.radius = 0.001 * static_cast<double>(below(1'000 * side));

        for (std::uint32_t i = 0; i < page.chunks; ++i)
        {
            const double gap = gap_of(page_box, page.box(i), sphere);
            const bool is_named = meets(sphere, box_of(page, page_box, i));
            const double slack = 1e-12 * (gap + sphere.radius);
            ASSERT_TRUE(is_named ? gap <= sphere.radius + slack : gap > sphere.radius - slack)
                << "round " << round << " chunk " << i;
            ++(is_named ? met : missed);
        }
    }
    EXPECT_GT(met, 2'000U);
    EXPECT_GT(missed, 10'000U);
}

} // namespace tactus::test
