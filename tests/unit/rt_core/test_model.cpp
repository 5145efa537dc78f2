// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/frame/model.hpp"
#include "tests/unit/rt_core/coded_bytes.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace tactus::test
{

namespace
{

/// Index pages that a model with this number keeps in this memory.
std::uint32_t index_pages_kept(std::uint32_t index_pages, std::size_t bytes)
{
    HeaderParts parts = sound_header(index_pages * kChunksPerIndexPage * kRecordsPerChunk);
    const auto coded = parts.write();
    return plan_capacities(parsed(coded), bytes, 0).index_pages;
}

/// Plan for these models in this memory; empty if there is none.
std::vector<ModelCapacities> plan_of(std::uint32_t records, std::size_t models, std::size_t bytes,
                                     std::uint32_t edit_faces = 0)
{
    HeaderParts parts = sound_header(records);
    const auto coded = parts.write();
    const std::vector<ModelHeader> headers(models, parsed(coded));
    std::vector<ModelCapacities> capacities(models);
    for (ModelCapacities& one : capacities)
    {
        one.edit_faces = edit_faces;
    }
    return try_plan(headers, bytes, 0, capacities) ? capacities : std::vector<ModelCapacities>{};
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

TEST(ModelCapacities, of_several_models_are_alike_and_fill_the_memory)
{
    constexpr std::uint32_t kRecords = 1'000 * kRecordsPerChunk;
    HeaderParts parts = sound_header(kRecords);
    const auto coded = parts.write();
    for (const auto& [models, bytes] : {std::pair<std::size_t, std::size_t>{1, 0x20'0000},
                                        {2, 0x20'0000},
                                        {8, 0x20'0000},
                                        {kMaxModels, 0x400'0000}})
    {
        const std::vector<ModelCapacities> plan = plan_of(kRecords, models, bytes);
        ASSERT_EQ(plan.size(), models);
        const std::vector<ModelHeader> headers(models, parsed(coded));
        const std::size_t needed = required_bytes(headers, plan);
        EXPECT_LE(needed, bytes);
        EXPECT_GT(needed, bytes - bytes / 50);
        for (const ModelCapacities& one : plan)
        {
            EXPECT_EQ(one.faces, plan[0].faces);
            EXPECT_LE(one.pages, plan[0].pages + 1);
            EXPECT_GE(one.pages + 1, plan[0].pages);
        }
    }
}

TEST(ModelCapacities, beside_a_room_for_edits_are_those_of_the_memory_that_it_leaves)
{
    constexpr std::uint32_t kRecords = 1'000 * kRecordsPerChunk;
    constexpr std::size_t kBytes = std::size_t{8} << 20U;
    const std::vector<ModelCapacities> half = plan_of(kRecords, 2, kBytes / 2);
    // 2 x 14,000 faces of 150 B are half of the memory.
    const std::vector<ModelCapacities> beside = plan_of(kRecords, 2, kBytes, 14'000);
    ASSERT_EQ(half.size(), 2U);
    ASSERT_EQ(beside.size(), 2U);
    for (const ModelCapacities& one : beside)
    {
        EXPECT_EQ(one.edit_faces, 14'000U);
        EXPECT_NEAR(one.faces, half[0].faces, 0.1 * half[0].faces);
        EXPECT_NEAR(one.pages, half[0].pages, 0.1 * half[0].pages);
    }
    EXPECT_TRUE(plan_of(kRecords, 2, kBytes / 2, 14'000).empty());
}

TEST(ModelCapacities, of_small_models_are_all_that_they_need)
{
    constexpr std::uint32_t kRecords = 4 * kRecordsPerChunk;
    const std::vector<ModelCapacities> plan = plan_of(kRecords, 3, std::size_t{4} << 20U);
    ASSERT_EQ(plan.size(), 3U);
    for (const ModelCapacities& one : plan)
    {
        EXPECT_EQ(one.pages, 4U);
        EXPECT_GE(one.faces, 2 * kRecords);
    }
    EXPECT_TRUE(plan_of(kRecords, 3, 1'000).empty());
}

} // namespace tactus::test
