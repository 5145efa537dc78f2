// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/limits.hpp"
#include "rt_core/spm/chunk_coding.hpp"
#include "rt_core/spm/ids.hpp"
#include "rt_core/spm/index_page.hpp"
#include "rt_core/spm/page.hpp"

#include <gtest/gtest.h>

#include <set>

namespace tactus::test
{

static_assert(FaceId{}.is_none() && !FaceId{0}.is_none());
static_assert(FaceId{1} < FaceId{2} && FaceId{0xFFFF'FFFEU} < FaceId{});

TEST(ModelCounts, ids_of_a_small_model_are_dense_and_distinct)
{
    constexpr ModelCounts sut{5, 6, 130};
    std::set<std::uint32_t> faces;
    for (std::uint32_t record = 0; record < sut.records; ++record)
    {
        const VertexId vertex = sut.vertex_of({record});
        EXPECT_FALSE(sut.is_base(vertex));
        EXPECT_EQ(vertex.value, 5 + record);
        EXPECT_EQ(sut.record_of(vertex), RecordId{record});
        for (const std::uint32_t side : {0U, 1U})
        {
            const FaceId face = sut.face_of({record}, side);
            EXPECT_FALSE(sut.is_base(face));
            EXPECT_LT(face.value, sut.face_ids());
            EXPECT_TRUE(faces.insert(face.value).second);
        }
    }
    EXPECT_EQ(*faces.begin(), 6U);
    EXPECT_EQ(faces.size(), 260U);
    EXPECT_EQ(sut.vertices(), 135U);
    EXPECT_EQ(sut.face_ids(), 266U);
    EXPECT_TRUE(sut.is_base(VertexId{4}));
    EXPECT_FALSE(sut.is_base(VertexId{5}));
    EXPECT_TRUE(sut.is_base(FaceId{5}));
    EXPECT_FALSE(sut.is_base(FaceId{6}));
}

static_assert(ModelCounts{3, 1, 0}.chunks() == 0 && ModelCounts{3, 1, 0}.index_pages() == 0);
static_assert(ModelCounts{3, 1, 1}.chunks() == 1 && ModelCounts{3, 1, 1}.index_pages() == 1);
static_assert(ModelCounts{3, 1, 64}.chunks() == 1 && ModelCounts{3, 1, 65}.chunks() == 2);
static_assert(ModelCounts{3, 1, 64 * 64}.index_pages() == 1);
static_assert(ModelCounts{3, 1, 64 * 64 + 1}.index_pages() == 2);
static_assert(ModelCounts{3, 1, kMaxRecords}.chunks() == 1U << 23U);

TEST(ModelCounts, the_last_chunk_and_page_hold_the_rest)
{
    constexpr ModelCounts sut{3, 1, 64 * 64 + 70};
    EXPECT_EQ(records_in_chunk(sut, {0}), 64U);
    EXPECT_EQ(records_in_chunk(sut, {64}), 64U);
    EXPECT_EQ(records_in_chunk(sut, {65}), 6U);
    EXPECT_EQ(chunks_in_index_page(sut, {0}), 64U);
    EXPECT_EQ(chunks_in_index_page(sut, {1}), 2U);
}

TEST(ModelCounts, the_largest_model_stays_clear_of_none)
{
    constexpr ModelCounts sut{kMaxBaseVertices, kMaxBaseFaces, kMaxRecords};
    constexpr RecordId last{kMaxRecords - 1};
    EXPECT_EQ(sut.face_of(last, 1).value + 1, sut.face_ids());
    EXPECT_LT(sut.face_ids(), FaceId::kNoneValue);
    EXPECT_EQ(sut.vertex_of(last).value + 1, sut.vertices());
    EXPECT_EQ(sut.record_of(sut.vertex_of(last)), last);
}

TEST(ModelCountsDeathTest, a_base_vertex_has_no_record)
{
    constexpr ModelCounts sut{5, 6, 10};
    EXPECT_DEATH(static_cast<void>(sut.record_of({4})), "");
}

TEST(RecordId, names_a_chunk_and_a_place_in_it)
{
    for (const std::uint32_t record : {0U, 63U, 64U, 65U, kMaxRecords - 1})
    {
        EXPECT_EQ(64 * chunk_of({record}).value + place_in_chunk({record}), record);
        EXPECT_LT(place_in_chunk({record}), 64U);
    }
}

TEST(FaceState, keeps_record_and_place_and_never_equals_the_base_state)
{
    EXPECT_TRUE(FaceState::base().is_base());
    for (const std::uint32_t record : {0U, 1U, 77U, kMaxRecords - 1})
    {
        for (std::uint32_t place = 0; place < kMaxStarFaces; ++place)
        {
            const FaceState sut = FaceState::after({record}, place);
            EXPECT_FALSE(sut.is_base());
            EXPECT_EQ(sut.record().value, record);
            EXPECT_EQ(sut.place(), place);
            EXPECT_NE(sut, FaceState::base());
        }
    }
}

} // namespace tactus::test
