// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
/// Laws of every reader of external bytes. Field ranges and named refusals are in each reader's own
/// tests.
#include "tests/codec/decoders.hpp"
#include "tests/shared/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

namespace tactus::codec
{

namespace
{

void flip_bit(Bytes& bytes, std::size_t bit)
{
    bytes[bit / 8] ^= std::byte{1} << (bit % 8);
}

class DecoderLaws : public testing::TestWithParam<Decoder>
{
protected:
    /// Refusal of the bytes, copied to separate memory so that a read beyond the end is detected.
    static std::string said_of(View bytes, std::size_t place)
    {
        const Reading reading = GetParam().read(Bytes(bytes.begin(), bytes.end()));
        EXPECT_TRUE(reading.is_lawful) << "place " << place << " " << reading.refusal;
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
    static void expect_noticed(const std::string& said, std::size_t place)
    {
        EXPECT_TRUE(!GetParam().sees_every_flip || !said.empty()) << "place " << place;
    }
};
using SealedDecoderLaws = DecoderLaws;
using VersionedDecoderLaws = DecoderLaws;

auto decoders_with(bool (*is_meant)(const Decoder&))
{
    std::vector<Decoder> decoders = all_decoders();
    std::erase_if(decoders, std::not_fn(is_meant));
    return testing::ValuesIn(decoders);
}

INSTANTIATE_TEST_SUITE_P(Of, DecoderLaws, testing::ValuesIn(all_decoders()),
                         testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(Of, SealedDecoderLaws,
                         decoders_with([](const Decoder& d) { return d.seal != nullptr; }),
                         testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(Of, VersionedDecoderLaws,
                         decoders_with([](const Decoder& d) { return !d.version_at.empty(); }),
                         testing::PrintToStringParamName());

TEST_P(DecoderLaws, a_sample_is_taken_whole_and_refused_when_cut_at_any_length)
{
    for (const Bytes& sample : GetParam().samples())
    {
        ASSERT_EQ(said_of(sample, sample.size()), "");
        for (std::size_t length = 0; length < sample.size(); ++length)
        {
            const std::string said = said_of(View(sample).first(length), length);
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
            // A bit decoder may be four bytes ahead of its output.
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
            flip_bit(bytes, bit);
            expect_noticed(said_of(bytes, bit), bit);
            flip_bit(bytes, bit);
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
            // Every second round has a valid start.
            const std::size_t right = round % 2 == 0 ? 0 : random.below(sample.size());
            std::copy_n(sample.begin(), std::min(right, bytes.size()), bytes.begin());
            expect_noticed(said_of(bytes, round), round);
        }
    }
}

TEST_P(SealedDecoderLaws, what_is_taken_under_a_right_checksum_is_in_range_and_not_cut)
{
    test::Random random(72);
    std::size_t taken = 0;
    for (const Bytes& sample : GetParam().samples())
    {
        for (std::size_t length = 0; length < sample.size(); ++length)
        {
            Bytes bytes = sample;
            bytes.resize(length);
            const std::string said = said_when_sealed(bytes, length);
            EXPECT_TRUE(!GetParam().tells_its_size || !said.empty()) << "cut at " << length;
        }
        for (std::size_t bit = 0; bit < 8 * sample.size(); ++bit)
        {
            Bytes bytes = sample;
            flip_bit(bytes, bit);
            taken += said_when_sealed(bytes, bit).empty() ? 1U : 0U;
            for (std::size_t hits = random.below(std::size_t{3}); hits > 0; --hits)
            {
                bytes[random.below(bytes.size())] = static_cast<std::byte>(random.bits());
            }
            taken += said_when_sealed(bytes, bit).empty() ? 1U : 0U;
        }
    }
    EXPECT_GT(taken, 100U); // Shows that bytes behind the checksum were tested.
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
                const bool is_first = at == GetParam().version_at.front();
                const auto version = std::to_integer<unsigned>(bytes[at]);
                if (!is_first || !std::ranges::count(GetParam().versions, version))
                {
                    expect_refused(said_of(bytes, at), GetParam().other_version, at);
                }
            }
            bytes[at] = right;
        }
    }
}

} // namespace

} // namespace tactus::codec
