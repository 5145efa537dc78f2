// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/piece_coding.hpp"
#include "host_tools/encode/range_encoder.hpp"
#include "rt_core/spm/chunk_coding.hpp"
#include "rt_core/spm/chunk_grammar.hpp"
#include "rt_core/spm/range_decoder.hpp"
#include "tests/unit/host_encode/encoded_model.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <memory>
#include <random>

namespace tactus
{
namespace
{

using Owner = CodedRecord::Owner;

std::uint32_t below(std::uint32_t end)
{
    return *rc::gen::inRange<std::uint32_t>(0, end);
}

std::uint64_t end_of_tier(RecordId id)
{
    std::uint64_t end = 64;
    while (id.value >= end)
    {
        end *= 5;
    }
    return end;
}

Owner arbitrary_owner(RecordId id, const ModelCounts& counts, bool may_be_derived)
{
    const std::uint32_t kind = below(may_be_derived ? 3 : 2);
    if (kind == 2)
    {
        return {};
    }
    const auto end =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(end_of_tier(id), counts.records));
    const std::uint32_t record = below(end);
    return kind == 0 || record == id.value ? Owner{below(counts.base_faces), Owner::Kind::base, {}}
                                           : Owner{record, Owner::Kind::record, {}};
}

std::int32_t arbitrary_number(std::int32_t most)
{
    const std::int32_t number = *rc::gen::inRange(-most, most);
    return *rc::gen::element(0, 1, -1, most, -most, number, number / 1'000, number / 1'000'000);
}

/// Random record that a chunk can code, including the limits of the ranges.
CodedRecord arbitrary_record(RecordId id, const ModelCounts& counts)
{
    CodedRecord record;
    record.anchor = arbitrary_owner(id, counts, false);
    record.place =
        static_cast<std::uint8_t>(record.anchor.kind == Owner::Kind::base ? 0 : below(8));
    record.corner = static_cast<std::uint8_t>(below(3));
    record.left = static_cast<std::uint8_t>(below(kMaxFanFaces));
    record.right = static_cast<std::uint8_t>(below(kMaxFanFaces - record.left));
    record.sides = static_cast<std::uint8_t>(below(4));
    for (std::uint32_t i = 0; i + 1 < record.fan_size(); ++i)
    {
        record.others[i] = arbitrary_owner(id, counts, true);
    }
    for (std::int32_t& residual : record.residual)
    {
        residual = arbitrary_number(1 << 27);
    }
    const auto largest = static_cast<ErrorCode>(below(256));
    for (std::uint32_t place = 0; place < 2 + record.fan_size(); ++place)
    {
        if (place >= 2 || record.has_face(place))
        {
            record.error[place] =
                place == 2 || largest == 0
                    ? largest
                    : rounded_error(static_cast<ErrorCode>(below(largest + 1U)), largest);
        }
    }
    for (std::uint32_t side = 0; side < 2; ++side)
    {
        record.bucket_step[side] =
            record.has_face(side) ? arbitrary_number(std::numeric_limits<std::int32_t>::max()) : 0;
    }
    return record;
}

std::vector<CodedRecord> arbitrary_chunk(ChunkId id, const ModelCounts& counts)
{
    std::vector<CodedRecord> records;
    for (std::uint32_t place = 0; place < records_in_chunk(counts, id); ++place)
    {
        records.push_back(arbitrary_record({(id.value << kRecordsPerChunkLog2) + place}, counts));
    }
    return records;
}

const ModelHeader& some_header()
{
    return sample_models()[1]->store->header();
}

std::vector<std::byte> some_chunk(ChunkId id)
{
    std::vector<std::byte> coded;
    EXPECT_TRUE(sample_models()[1]->store->read({ContentKind::chunk, id.value}, coded));
    return coded;
}

Result<Done, SpmRefusal> parse(std::span<const std::byte> bytes, ChunkId id, Page& page)
{
    return parse_chunk(bytes, some_header(), id, page);
}

std::vector<std::byte> with_right_checksum(std::vector<std::byte> code, ChunkId id)
{
    const std::uint32_t checksum = chunk_checksum(code, id);
    const auto bytes = std::as_bytes(std::span(&checksum, 1));
    code.insert(code.end(), bytes.begin(), bytes.end());
    return code;
}

RC_GTEST_PROP(ChunkCoding, parse_gives_back_what_encode_wrote, ())
{
    const ModelHeader& header = some_header();
    const ChunkId id{below(header.counts().chunks())};
    const std::vector<CodedRecord> written = arbitrary_chunk(id, header.counts());
    const auto coded = encode_chunk(id, header.counts(), written);
    auto page = std::make_unique<Page>();
    RC_ASSERT(coded.size() <= kMaxCodedChunkBytes);
    RC_ASSERT(parse(coded, id, *page).has_value());
    for (std::size_t place = 0; place < written.size(); ++place)
    {
        RC_ASSERT(coded_form(page->records[place]) == written[place]);
    }
    for (std::size_t place = written.size(); place < kRecordsPerChunk; ++place)
    {
        RC_ASSERT(page->records[place].fan_size == 0);
    }
}

TEST(ChunkCoding, the_chunk_of_another_number_is_refused)
{
    const auto page = std::make_unique<Page>();
    EXPECT_EQ(parse(some_chunk({1}), {2}, *page).error(), SpmRefusal::wrong_checksum);
}

/// Encoder that inverts one bit, and continues as if that were the input.
struct BendingEncoder
{
    explicit BendingEncoder(std::size_t bent) : bent_(bent) {}

    std::uint32_t code_bit(Probability& zero, std::uint32_t bit)
    {
        return encoder_.code_bit(zero, count_++ == bent_ ? bit ^ 1U : bit);
    }
    std::uint32_t code_raw(std::uint32_t bits, std::uint32_t value)
    {
        return encoder_.code_raw(bits, value);
    }
    [[nodiscard]] std::size_t count() const { return count_; }
    [[nodiscard]] std::vector<std::byte> finish() { return encoder_.finish(); }

private:
    RangeEncoder encoder_;
    std::size_t bent_;
    std::size_t count_{0};
};

TEST(ChunkCoding, a_bent_bit_of_a_record_is_read_as_bent_or_refused)
{
    const ChunkId id{1};
    const ModelCounts counts = some_header().counts();
    const auto page = std::make_unique<Page>();
    ASSERT_TRUE(parse(some_chunk(id), id, *page).has_value());
    std::vector<CodedRecord> records(records_in_chunk(counts, id));
    for (std::size_t place = 0; place < records.size(); ++place)
    {
        records[place] = coded_form(page->records[place]);
    }
    std::size_t unsound = 0;
    std::size_t read = 0;
    bool is_past_end = false;
    for (std::size_t bent = 0; !is_past_end; ++bent)
    {
        BendingEncoder encoder(bent);
        ChunkGrammar grammar(encoder, counts, id);
        std::vector<CodedRecord> written = records;
        for (std::uint32_t place = 0; place < written.size(); ++place)
        {
            grammar.code({(id.value << kRecordsPerChunkLog2) + place}, written[place]);
        }
        is_past_end = bent >= encoder.count();
        const auto parsed = parse(with_right_checksum(encoder.finish(), id), id, *page);
        unsound += grammar.is_sound() ? 0U : 1U;
        read += parsed.has_value() ? 1U : 0U;
        if (!parsed)
        {
            ASSERT_EQ(parsed.error(), SpmRefusal::value_out_of_range) << "bit " << bent;
            continue;
        }
        ASSERT_TRUE(grammar.is_sound()) << "bit " << bent;
        for (std::size_t place = 0; place < written.size(); ++place)
        {
            // Fields that a smaller fan or another kind of anchor does not store.
            const std::size_t named = written[place].fan_size() - 1;
            std::fill(written[place].others.begin() + static_cast<std::ptrdiff_t>(named),
                      written[place].others.end(), Owner{});
            const bool is_base = written[place].anchor.kind == Owner::Kind::base;
            written[place].place = is_base ? std::uint8_t{0} : written[place].place;
            ASSERT_EQ(coded_form(page->records[place]), written[place]) << "bit " << bent;
        }
    }
    EXPECT_GT(unsound, 10U);
    EXPECT_GT(read, 1'000U);
}

RC_GTEST_PROP(RangeCoder, gives_back_bits_of_any_probability, (std::uint32_t seed))
{
    std::mt19937 random(seed);
    constexpr std::uint32_t kBits = 3'000;
    // Long runs of unlikely bits propagate carries far back.
    const bool is_carrying = seed % 2 == 0;
    std::vector<Probability> start;
    std::vector<std::uint32_t> bits;
    for (std::uint32_t i = 0; i < kBits; ++i)
    {
        start.push_back(static_cast<Probability>(is_carrying ? 4'065 : 31 + random() % 4'035));
        bits.push_back(is_carrying ? 1U : random() % 2);
    }
    RangeEncoder encoder;
    for (std::uint32_t i = 0; i < kBits; ++i)
    {
        Probability zero = start[i];
        encoder.code_bit(zero, bits[i]);
        encoder.code_raw(i % 9, i & ((1U << i % 9) - 1));
    }
    const std::vector<std::byte> code = encoder.finish();
    RangeDecoder decoder(code);
    for (std::uint32_t i = 0; i < kBits; ++i)
    {
        Probability zero = start[i];
        RC_ASSERT(decoder.code_bit(zero) == bits[i]);
        RC_ASSERT(decoder.code_raw(i % 9) == (i & ((1U << i % 9) - 1)));
    }
    RC_ASSERT(!decoder.has_bytes_left());
}

TEST(RangeCoder, an_empty_code_is_all_zeros)
{
    RangeEncoder encoder;
    EXPECT_TRUE(encoder.finish().empty());
    RangeDecoder decoder({});
    EXPECT_EQ(decoder.code_raw(20), 0U);
}

TEST(ChunkErrors, are_never_rounded_down_and_exact_only_when_they_were)
{
    for (std::uint32_t largest = 1; largest < 256; ++largest)
    {
        for (std::uint32_t error = 0; error <= largest; ++error)
        {
            const ErrorCode rounded =
                rounded_error(static_cast<ErrorCode>(error), static_cast<ErrorCode>(largest));
            EXPECT_GE(rounded, error);
            EXPECT_LE(rounded, largest);
            EXPECT_EQ(rounded == 0, error == 0);
            EXPECT_TRUE(error + 28 < largest || rounded <= error + 1);
        }
    }
}

} // namespace
} // namespace tactus
