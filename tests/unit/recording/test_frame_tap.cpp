// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/frame_tap.hpp"
#include "tests/unit/recording/recorded_example.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace tactus::test
{
namespace
{

void record(FrameTap& tap, ExampleFrame& frame, std::int64_t number)
{
    frame.tools[0].sample_time_ns = number;
    tap.record(frame.input(), frame.output());
}

/// Takes what waits; the numbers that record() gave the frames.
std::vector<std::int64_t> take_all(FrameTap& tap, FrameDecoder& decoder)
{
    std::vector<std::int64_t> numbers;
    for (std::vector<std::byte> coded; tap.try_take(coded);)
    {
        ByteReader reader(coded);
        EXPECT_EQ(decoder.decode(reader), nullptr);
        EXPECT_TRUE(reader.at_end());
        numbers.push_back(decoder.frame().tools[0].sample_time_ns);
    }
    return numbers;
}

TEST(FrameTap, has_nothing_before_a_frame_was_recorded)
{
    FrameTap sut(16);
    std::vector<std::byte> coded;
    EXPECT_FALSE(sut.try_take(coded));
    EXPECT_EQ(sut.lost_from(), kNoFrame);
}

TEST(FrameTap, gives_frames_in_order)
{
    FrameTap sut(64);
    FrameDecoder decoder(kExampleShape);
    ExampleFrame frame;
    for (const std::int64_t number : {1, 2, 3})
    {
        record(sut, frame, number);
    }
    EXPECT_EQ(take_all(sut, decoder), (std::vector<std::int64_t>{1, 2, 3}));
    record(sut, frame, 4);
    EXPECT_EQ(take_all(sut, decoder), std::vector<std::int64_t>{4});
    EXPECT_EQ(sut.lost_from(), kNoFrame);
}

TEST(FrameTap, loses_all_frames_from_the_first_that_finds_no_room)
{
    ExampleFrame frame;
    FrameEncoder encoder;
    const std::size_t first_cells = (frame.code(encoder).size() + 63) / 64;
    FrameTap sut(first_cells + 2); // The others take more than two.
    FrameDecoder decoder(kExampleShape);
    record(sut, frame, 0);
    EXPECT_EQ(sut.lost_from(), kNoFrame);
    record(sut, frame, 1);
    EXPECT_EQ(sut.lost_from(), 1U);
    EXPECT_EQ(take_all(sut, decoder), std::vector<std::int64_t>{0});
    record(sut, frame, 2); // There is room again, but a replay can't go past the gap.
    EXPECT_TRUE(take_all(sut, decoder).empty());
    EXPECT_EQ(sut.lost_from(), 1U);
}

TEST(FrameTap, of_the_last_inputs_keeps_the_newest_and_the_frame_that_failed)
{
    ExampleFrame frame;
    FrameTap sut(32, FrameTap::Keeps::last_inputs);
    for (std::int64_t number = 0; number < 1'000; ++number)
    {
        record(sut, frame, number);
    }
    frame.tools[0].sample_time_ns = 1'000;
    sut.record_failed({frame.input(), frame.door, frame.devices});
    EXPECT_EQ(sut.lost_from(), kNoFrame);
    FrameDecoder decoder(kExampleShape); // Each frame can be the first.
    const std::vector<std::int64_t> kept = take_all(sut, decoder);
    ASSERT_GE(kept.size(), 2U);
    EXPECT_LE(kept.size(), 8U);
    EXPECT_EQ(kept.back(), 1'000);
    EXPECT_EQ(kept.front(), 1'001 - static_cast<std::int64_t>(kept.size()));
    EXPECT_FALSE(decoder.frame().has_hashes);
    EXPECT_TRUE(decoder.frame().events.empty()) << "nobody keeps the pieces";
    EXPECT_EQ(decoder.frame().budgets, frame.budgets);
}

TEST(FrameTap, of_a_run_ends_with_the_frame_that_failed_unless_one_is_lost)
{
    ExampleFrame frame;
    FrameTap sut(64);
    FrameDecoder decoder(kExampleShape);
    record(sut, frame, 0);
    frame.tools[0].sample_time_ns = 1;
    sut.record_failed({frame.input(), frame.door, frame.devices});
    EXPECT_EQ(take_all(sut, decoder), (std::vector<std::int64_t>{0, 1}));
    EXPECT_FALSE(decoder.frame().has_hashes);
    EXPECT_EQ(decoder.frame().events.size(), frame.events.size());

    FrameTap full(2);
    record(full, frame, 0);
    full.record_failed({frame.input(), frame.door, frame.devices});
    EXPECT_EQ(full.lost_from(), 0U);
    EXPECT_TRUE(take_all(full, decoder).empty());
}

TEST(FrameTap, carries_frames_between_threads)
{
    constexpr std::int64_t kFrames = 2'000;
    FrameTap sut(128);
    FrameDecoder decoder(kExampleShape);
    std::atomic<std::int64_t> taken{0};
    std::thread producer(
        [&]
        {
            ExampleFrame frame;
            for (std::int64_t number = 0; number < kFrames; ++number)
            {
                while (number - taken.load() > 4) // Within what the queue holds.
                {
                    std::this_thread::yield();
                }
                record(sut, frame, number);
            }
        });
    while (taken.load() < kFrames)
    {
        for (const std::int64_t number : take_all(sut, decoder))
        {
            ASSERT_EQ(number, taken.load());
            taken.store(number + 1);
        }
    }
    producer.join();
    EXPECT_EQ(sut.lost_from(), kNoFrame);
}

} // namespace
} // namespace tactus::test
