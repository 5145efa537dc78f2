// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/model.hpp"
#include "tests/unit/rt_core/coded_bytes.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace tactus::test
{

namespace
{

/// Index pages that a model with so many keeps in so much memory.
std::uint32_t index_pages_kept(std::uint32_t index_pages, std::size_t bytes)
{
    HeaderParts parts = sound_header(index_pages * kChunksPerIndexPage * kRecordsPerChunk);
    const auto coded = parts.write();
    return plan_capacities(parsed(coded), bytes, 0).index_pages;
}

} // namespace

TEST(ModelCapacities, keep_the_least_number_of_index_pages_and_more_only_where_there_is_memory)
{
    constexpr std::size_t kLittle = std::size_t{2} << 20U;
    constexpr std::size_t kMuch = std::size_t{64} << 20U;
    constexpr std::uint32_t kLeast = kLeastResidentIndexPages;
    EXPECT_EQ(index_pages_kept(kLeast - 1, kLittle), kLeast - 1);
    EXPECT_EQ(index_pages_kept(kLeast, kLittle), kLeast);
    EXPECT_EQ(index_pages_kept(kLeast + 1, kLittle), kLeast);
    EXPECT_EQ(index_pages_kept(kLeast + 1, kMuch), kLeast + 1);
}

} // namespace tactus::test
