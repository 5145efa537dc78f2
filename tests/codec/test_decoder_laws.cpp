// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
/// What holds of every reader of bytes from outside. Ranges of fields, and refusals by name, stand
/// with each reader's own tests.
#include "tests/codec/decoders.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace tactus::codec
{

namespace
{

class DecoderLaws : public testing::TestWithParam<Decoder>
{
protected:
    /// What is said of the bytes, which lie in memory of their own, so that a read beyond is seen.
    static std::string said_of(std::span<const std::byte> bytes, std::size_t place)
    {
        const Bytes own(bytes.begin(), bytes.end());
        const Reading reading = GetParam().read(own);
        EXPECT_TRUE(reading.keeps_promise) << "place " << place << " " << reading.refusal;
        return reading.refusal;
    }
    static std::string said_when_sealed(Bytes bytes, std::size_t place)
    {
        GetParam().seal(bytes);
        return said_of(bytes, place);
    }
    static void expect_refused(const std::string& said, const std::string& part, std::size_t place)
    {
        EXPECT_TRUE(!said.empty() && said.find(part) != std::string::npos)
            << "place " << place << " '" << said << "' without '" << part << "'";
    }
};
using SealedDecoderLaws = DecoderLaws;
using VersionedDecoderLaws = DecoderLaws;

std::vector<Decoder> decoders_with(const std::function<bool(const Decoder&)>& is_meant)
{
    std::vector<Decoder> all = model_decoders();
    std::ranges::copy(message_decoders(), std::back_inserter(all));
    std::erase_if(all, std::not_fn(is_meant));
    return all;
}

std::string decoder_name(const testing::TestParamInfo<Decoder>& decoder)
{
    return decoder.param.name;
}

INSTANTIATE_TEST_SUITE_P(Of, DecoderLaws,
                         testing::ValuesIn(decoders_with([](const Decoder&) { return true; })),
                         decoder_name);
INSTANTIATE_TEST_SUITE_P(Of, SealedDecoderLaws,
                         testing::ValuesIn(decoders_with([](const Decoder& decoder)
                                                         { return decoder.seal != nullptr; })),
                         decoder_name);
INSTANTIATE_TEST_SUITE_P(Of, VersionedDecoderLaws,
                         testing::ValuesIn(decoders_with([](const Decoder& decoder)
                                                         { return !decoder.version_at.empty(); })),
                         decoder_name);

TEST_P(DecoderLaws, a_sample_is_taken_whole_and_refused_when_cut_at_any_length)
{
    for (const Bytes& sample : GetParam().samples())
    {
        ASSERT_EQ(said_of(sample, sample.size()), "");
        for (std::size_t length = 0; length < sample.size(); ++length)
        {
            const std::string said = said_of(std::span(sample).first(length), length);
            if (std::ranges::count(GetParam().whole_at, length) == 0)
            {
                expect_refused(said, GetParam().cut, length);
            }
            else
            {
                EXPECT_EQ(said, "") << length;
            }
        }
    }
}

TEST_P(DecoderLaws, bytes_behind_a_sample_are_refused)
{
    for (Bytes longer : GetParam().samples())
    {
        const std::size_t whole = longer.size();
        for (const std::size_t size : {whole + 1, whole + 2, whole + 5, whole + 64})
        {
            longer.resize(size, std::byte{0xFF});
            const std::string said = said_of(longer, size);
            const bool is_sealed = GetParam().seal != nullptr;
            expect_refused(said, is_sealed ? "" : GetParam().followed, size);
            // A decoder of bits may be four bytes ahead of what it has decoded.
            if (is_sealed && size >= whole + 5)
            {
                expect_refused(said_when_sealed(longer, size), GetParam().followed, size);
            }
        }
    }
}

TEST_P(DecoderLaws, a_flipped_bit_is_noticed_or_read_as_it_stands)
{
    for (Bytes bytes : GetParam().samples())
    {
        for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit)
        {
            bytes[bit / 8] ^= std::byte{1} << (bit % 8);
            const std::string said = said_of(bytes, bit);
            ASSERT_TRUE(!GetParam().sees_every_flip || !said.empty()) << "bit " << bit;
            bytes[bit / 8] ^= std::byte{1} << (bit % 8);
        }
    }
}

TEST_P(DecoderLaws, garbage_is_refused_or_read_as_it_stands)
{
    test::Random random(71);
    for (const Bytes& sample : GetParam().samples())
    {
        for (std::size_t round = 0; round < 2'000; ++round)
        {
            Bytes bytes(random.below(2 * sample.size()));
            std::ranges::generate(bytes, [&] { return static_cast<std::byte>(random.bits()); });
            // Every second time behind a start that is right.
            const std::size_t right = round % 2 == 0 ? 0 : random.below(sample.size());
            std::copy_n(sample.begin(), std::min(right, bytes.size()), bytes.begin());
            const std::string said = said_of(bytes, round);
            ASSERT_TRUE(!GetParam().sees_every_flip || !said.empty()) << "round " << round;
        }
    }
}

TEST_P(SealedDecoderLaws, a_cut_sample_is_refused_or_in_range_under_a_right_checksum)
{
    for (const Bytes& sample : GetParam().samples())
    {
        for (std::size_t length = 0; length < sample.size(); ++length)
        {
            const auto end = sample.begin() + static_cast<std::ptrdiff_t>(length);
            const std::string said = said_when_sealed({sample.begin(), end}, length);
            EXPECT_TRUE(!GetParam().tells_its_size || !said.empty()) << "cut at " << length;
        }
    }
}

TEST_P(SealedDecoderLaws, whatever_is_taken_under_a_right_checksum_is_in_range)
{
    test::Random random(72);
    std::size_t taken = 0;
    for (const Bytes& sample : GetParam().samples())
    {
        for (std::size_t bit = 0; bit < 8 * sample.size(); ++bit)
        {
            Bytes bytes = sample;
            bytes[bit / 8] ^= std::byte{1} << (bit % 8);
            taken += said_when_sealed(bytes, bit).empty() ? 1U : 0U;
        }
        for (std::size_t round = 0; round < 5'000; ++round)
        {
            Bytes bytes = sample;
            for (std::size_t hits = 1 + random.below(std::size_t{3}); hits > 0; --hits)
            {
                bytes[random.below(bytes.size())] = static_cast<std::byte>(random.bits());
            }
            taken += said_when_sealed(bytes, round).empty() ? 1U : 0U;
        }
    }
    EXPECT_GT(taken, 100U); // Else nothing behind the checksum was looked at.
}

TEST_P(VersionedDecoderLaws, every_other_version_is_refused_by_that_name)
{
    for (Bytes bytes : GetParam().samples())
    {
        for (const std::size_t at : GetParam().version_at)
        {
            const std::byte right = bytes[at];
            for (unsigned change = 1; change < 256; ++change)
            {
                bytes[at] = right ^ static_cast<std::byte>(change);
                expect_refused(said_of(bytes, at), GetParam().unknown_version, at);
            }
            bytes[at] = right;
        }
    }
}

} // namespace

} // namespace tactus::codec
