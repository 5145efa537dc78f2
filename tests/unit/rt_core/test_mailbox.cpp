// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/base/mailbox.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace tactus
{

namespace
{

/// Letter whose size is not a whole number of words.
struct Letter
{
    std::array<std::uint32_t, 19> words{};
};

Letter letter_of(std::uint32_t number)
{
    Letter letter;
    for (std::uint32_t i = 0; i < letter.words.size(); ++i)
    {
        letter.words.at(i) = number ^ (i * 0x9E37'79B9U);
    }
    return letter;
}

TEST(Mailbox, gives_nothing_before_the_first_write_and_leaves_the_value)
{
    const Mailbox<Letter> sut;
    Letter letter = letter_of(5);
    EXPECT_FALSE(sut.try_read(letter));
    EXPECT_EQ(letter.words, letter_of(5).words);
}

TEST(Mailbox, gives_the_newest_value_again_and_again)
{
    Mailbox<Letter> sut;
    sut.write(letter_of(1));
    sut.write(letter_of(2));
    for (int i = 0; i < 3; ++i)
    {
        Letter letter;
        ASSERT_TRUE(sut.try_read(letter));
        EXPECT_EQ(letter.words, letter_of(2).words);
    }
}

/// The writer continues until every reader has read enough different letters, so that reads and
/// writes do interleave.
TEST(Mailbox, never_mixes_two_letters_and_never_goes_back)
{
    constexpr int kPoseSamples = 1'000;
    Mailbox<Letter> sut;
    sut.write(letter_of(0));
    std::atomic<int> reading{2};
    std::atomic<int> faults{0};
    const auto read = [&]
    {
        std::uint32_t last = 0;
        for (int seen = 0; seen < kPoseSamples;)
        {
            Letter letter;
            if (!sut.try_read(letter))
            {
                std::this_thread::yield(); // The writer may be within one here.
                continue;
            }
            const std::uint32_t number = letter.words[0];
            faults += letter.words != letter_of(number).words || number < last ? 1 : 0;
            seen += number != last ? 1 : 0;
            if (number == last)
            {
                std::this_thread::yield();
            }
            last = number;
        }
        --reading;
    };
    std::vector<std::thread> readers;
    readers.emplace_back(read);
    readers.emplace_back(read);
    for (std::uint32_t number = 1; reading > 0; ++number)
    {
        sut.write(letter_of(number));
        if (number % 8 == 0) // Readers can interleave, even on one processor.
        {
            std::this_thread::yield();
        }
    }
    for (std::thread& reader : readers)
    {
        reader.join();
    }
    EXPECT_EQ(faults, 0);
}

} // namespace

} // namespace tactus
