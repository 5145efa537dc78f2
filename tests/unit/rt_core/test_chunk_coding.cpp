// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/spm/chunk_coding.hpp"
#include "tests/unit/rt_core/coded_bytes.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <memory>

namespace tactus::test
{

namespace
{

/// 70 records: the second chunk holds the last six, 64 .. 69.
constexpr std::uint32_t kRecords = 70;
constexpr ChunkId kChunk{1};

struct CodedRecord
{
    std::uint32_t depth{2};
    std::uint8_t shape{2 | 8 | 16};
    std::array<std::int32_t, 3> step{10, 20, 30}; ///< From the record before.
    std::uint32_t parent{1};
    std::vector<std::array<std::uint32_t, 2>> fan{{0, 0}, {5, 1 + 8 * 3 + 2}}; ///< Face, state.
    std::vector<std::uint8_t> errors{0, 9, 8, 0};
    std::vector<std::uint32_t> buckets{77, 1'000'000};
    std::uint8_t reach{33};
};

struct CodedChunk
{
    std::uint32_t number{1};
    std::uint8_t count{6};
    std::array<CodedRecord, 6> records;
    std::size_t extra_bytes{0};

    [[nodiscard]] std::vector<std::byte> write() const
    {
        CodedBytes bytes;
        bytes.put(number).put(count);
        for (const CodedRecord& record : records)
        {
            bytes.varint(record.depth).put(record.shape);
            for (const std::int32_t step : record.step)
            {
                bytes.zigzag(step);
            }
            bytes.varint(record.parent);
            for (const auto& [face, state] : record.fan)
            {
                bytes.varint(face).varint(state);
            }
            for (const std::uint8_t error : record.errors)
            {
                bytes.put(error);
            }
            for (const std::uint32_t bucket : record.buckets)
            {
                bytes.varint(bucket);
            }
            bytes.put(record.reach);
        }
        return bytes.zeros(extra_bytes).with_checksum();
    }
};

class ChunkCodingTest : public ::testing::Test
{
protected:
    Result<Done, SpmRefusal> parse(std::span<const std::byte> bytes)
    {
        return parse_chunk(bytes, header_, kChunk, *page_);
    }
    /// Why the chunk is refused when its third record is changed and the checksum made to match.
    SpmRefusal refusal_after(const std::function<void(CodedRecord&)>& change)
    {
        CodedChunk chunk;
        change(chunk.records[2]);
        const auto result = parse(chunk.write());
        return result ? SpmRefusal{255} : result.error();
    }

    std::vector<std::byte> header_bytes_{sound_header(kRecords).write()};
    ModelHeader header_{parsed(header_bytes_)};
    std::unique_ptr<Page> page_{std::make_unique<Page>()};
};

} // namespace

TEST_F(ChunkCodingTest, a_sound_chunk_gives_its_records_back)
{
    CodedChunk chunk;
    chunk.records[1].shape = 2 | 16;
    chunk.records[1].errors = {9, 8, 0};
    chunk.records[1].buckets = {1'000'000};
    chunk.records[1].step = {-10, -20, -30};

    ASSERT_TRUE(parse(chunk.write()).has_value());

    const VsplitRecord& first = page_->records[0];
    EXPECT_EQ(first.position_m, (Vec3f{10.0F / 1'024, 20.0F / 1'024, 30.0F / 1'024}));
    EXPECT_EQ(first.depth, 2);
    EXPECT_EQ(first.parent, VertexId{1});
    EXPECT_EQ(first.star[0], FaceId{4 + 2 * 64});
    EXPECT_EQ(first.star[1], FaceId{4 + 2 * 64 + 1});
    EXPECT_EQ(first.star[3], FaceId{5});
    EXPECT_TRUE(first.star[4].is_none());
    EXPECT_TRUE(first.before[0].is_base());
    EXPECT_EQ(first.before[1], FaceState::after({3}, 2));
    EXPECT_EQ(first.next[0], kNextExact);
    EXPECT_EQ(first.next[1], kNextPending);
    EXPECT_EQ(first.next[2], kNextPending);
    EXPECT_EQ(first.next[3], kNextExact);
    EXPECT_EQ(first.bucket, (std::array<std::uint32_t, 2>{77, 1'000'000}));
    EXPECT_EQ(first.reach, 33);
    const VsplitRecord& border = page_->records[1];
    EXPECT_TRUE(border.star[0].is_none());
    EXPECT_EQ(border.star[1], FaceId{4 + 2 * 65 + 1});
    EXPECT_EQ(border.position_m, (Vec3f{0, 0, 0}));
    EXPECT_EQ(border.bucket[1], 1'000'000U);
    EXPECT_EQ(page_->records[5].fan_size, 2);
}

TEST_F(ChunkCodingTest, unused_places_of_a_shorter_page_are_cleared)
{
    std::fill_n(reinterpret_cast<std::byte*>(page_.get()), sizeof(Page), std::byte{0xEE});

    ASSERT_TRUE(parse(CodedChunk().write()).has_value());

    for (std::size_t place = 6; place < kRecordsPerChunk; ++place)
    {
        EXPECT_EQ(page_->records[place].fan_size, 0);
        EXPECT_TRUE(page_->records[place].star[2].is_none());
    }
}

TEST_F(ChunkCodingTest, every_truncation_is_refused)
{
    const auto bytes = CodedChunk().write();
    for (std::size_t length = 0; length < bytes.size(); ++length)
    {
        ASSERT_FALSE(parse(std::span(bytes).first(length)).has_value()) << length;
    }
}

TEST_F(ChunkCodingTest, every_truncation_under_a_right_checksum_is_refused)
{
    const auto bytes = CodedChunk().write();
    for (std::size_t length = 0; length + kChecksumBytes < bytes.size(); ++length)
    {
        CodedBytes cut;
        for (std::size_t i = 0; i < length; ++i)
        {
            cut.put(bytes[i]);
        }
        ASSERT_FALSE(parse(cut.with_checksum()).has_value()) << length;
    }
}

TEST_F(ChunkCodingTest, every_single_bit_flip_is_refused)
{
    auto bytes = CodedChunk().write();
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit)
    {
        flip_bit(bytes, bit);
        ASSERT_FALSE(parse(bytes).has_value()) << "bit " << bit;
        flip_bit(bytes, bit);
    }
}

TEST_F(ChunkCodingTest, flips_under_a_right_checksum_never_read_outside_or_name_a_foreign_id)
{
    const auto bytes = CodedChunk().write();
    const auto content = std::span(bytes).first(bytes.size() - kChecksumBytes);
    for (std::size_t bit = 0; bit < 8 * content.size(); ++bit)
    {
        std::vector<std::byte> flipped(content.begin(), content.end());
        flip_bit(flipped, bit);
        CodedBytes closed;
        for (const std::byte byte : flipped)
        {
            closed.put(byte);
        }
        if (!parse(closed.with_checksum()).has_value())
        {
            continue;
        }
        for (std::uint32_t place = 0; place < 6; ++place)
        {
            const VsplitRecord& record = page_->records[place];
            ASSERT_LT(record.parent.value, header_.counts().vertices()) << "bit " << bit;
            ASSERT_LE(record.star_end(), kMaxStarFaces) << "bit " << bit;
            for (std::uint32_t i = 0; i < record.fan_size; ++i)
            {
                ASSERT_LT(record.star[2 + i].value, header_.counts().face_ids());
                ASSERT_TRUE(record.before[i].is_base() ||
                            record.before[i].record().value < kRecords);
            }
        }
    }
}

TEST_F(ChunkCodingTest, another_chunks_number_or_count_is_refused)
{
    CodedChunk chunk;
    chunk.number = 0;
    EXPECT_EQ(parse(chunk.write()).error(), SpmRefusal::wrong_identity);
    chunk.number = 1;
    chunk.count = 5;
    EXPECT_EQ(parse(chunk.write()).error(), SpmRefusal::wrong_identity);
    chunk.count = 64;
    EXPECT_EQ(parse(chunk.write()).error(), SpmRefusal::wrong_identity);
}

TEST_F(ChunkCodingTest, bytes_behind_the_last_record_are_refused)
{
    CodedChunk chunk;
    chunk.extra_bytes = 1;
    EXPECT_EQ(parse(chunk.write()).error(), SpmRefusal::trailing_bytes);
}

TEST_F(ChunkCodingTest, each_field_out_of_range_is_refused)
{
    const std::vector<std::function<void(CodedRecord&)>> changes{
        [](CodedRecord& r) { r.depth = 0; },
        [](CodedRecord& r) { r.depth = 10; },
        [](CodedRecord& r) { r.depth = 0x1'0002; },
        [](CodedRecord& r) { r.shape = 8 | 16; },
        [](CodedRecord& r) { r.shape = 7 | 8 | 16; },
        [](CodedRecord& r) { r.shape = 2; },
        [](CodedRecord& r) { r.shape = 32 | 2 | 8 | 16; },
        [](CodedRecord& r) { r.step[0] = -21; },
        [](CodedRecord& r) { r.step[0] = 981; },
        [](CodedRecord& r) { r.step[2] = std::numeric_limits<std::int32_t>::max(); },
        [](CodedRecord& r) { r.step[1] = std::numeric_limits<std::int32_t>::min(); },
        [](CodedRecord& r) { r.parent = 4 + kRecords; },
        [](CodedRecord& r) { r.parent = 4 + 66; }, // The vertex that the record itself adds.
        [](CodedRecord& r) { r.parent = 0xFFFF'FFFFU; },
        [](CodedRecord& r) { r.fan[1][0] = 4 + 2 * kRecords; },
        [](CodedRecord& r) { r.fan[1][0] = 0xFFFF'FFFFU; },
        [](CodedRecord& r) { r.fan[0][0] = 4; }, // No base face, so it has no base state.
        [](CodedRecord& r) { r.fan[1][1] = 1 + 8 * kRecords; },
        [](CodedRecord& r) { r.fan[1][1] = 1 + 8 * 66 + 3; }, // Its own star.
        [](CodedRecord& r) { r.fan[1][1] = 0xFFFF'FFFFU; },
        [](CodedRecord& r) { r.reach = 0; },
    };
    for (std::size_t i = 0; i < changes.size(); ++i)
    {
        EXPECT_EQ(refusal_after(changes[i]), SpmRefusal::value_out_of_range) << "change " << i;
    }
    EXPECT_EQ(refusal_after(
                  [](CodedRecord& r)
                  {
                      r.step[0] = 970;
                      r.depth = 9;
                  }),
              SpmRefusal::value_out_of_range)
        << "later records leave the extent";
    EXPECT_EQ(refusal_after([](CodedRecord& r) { r.depth = 9; }), SpmRefusal{255});
}

} // namespace tactus::test
