// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/frame_tap.hpp"
#include "platform/recording/last_inputs.hpp"
#include "platform/recording/recording.hpp"
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

/// Takes all waiting frames; returns the numbers that record() gave them.
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
    record(sut, frame, 2); // There is space again, but a replay cannot pass the gap.
    EXPECT_TRUE(take_all(sut, decoder).empty());
    EXPECT_EQ(sut.lost_from(), 1U);
}

TEST(LastInputs, keeps_the_newest_in_order)
{
    const TinyModel model = make_tiny_model({});
    for (const std::int64_t frames : {0, 1, 4, 5, 6, 1'003})
    {
        LastInputs sut(2, 11); // Five frames, and one sample too few for a sixth.
        std::array<ToolState, 2> tools{};
        std::array<DeviceRecord, 2> devices{};
        for (std::int64_t number = 0; number < frames; ++number)
        {
            tools[0].sample_time_ns = number;
            tools[1].position_m.x() = static_cast<double>(number);
            devices[1].buttons = static_cast<std::uint32_t>(number);
            sut.keep({tools, {}, {}, number}, devices);
        }
        RecordedSetup setup = example_setup(model);
        setup.tools.resize(2);
        RecordingWriter writer(setup);
        sut.write_to(writer);
        writer.finish(kNoFrame);
        EXPECT_EQ(writer.frames(), static_cast<std::uint64_t>(std::min<std::int64_t>(frames, 5)));
        const auto recording = Recording::parse(writer.take_bytes(), "last.rec");
        ASSERT_TRUE(recording) << recording.error().text;
        FrameDecoder decoder(recording.value().shape());
        std::int64_t number = std::max<std::int64_t>(frames - 5, 0);
        for (ByteReader reader(recording.value().frames()); !reader.at_end(); ++number)
        {
            ASSERT_EQ(decoder.decode(reader), nullptr);
            EXPECT_FALSE(decoder.frame().has_hashes);
            EXPECT_EQ(decoder.frame().now_ns, number);
            EXPECT_EQ(decoder.frame().tools[0].sample_time_ns, number);
            EXPECT_EQ(decoder.frame().tools[1].position_m.x(), static_cast<double>(number));
            EXPECT_EQ(decoder.frame().devices[1].buttons, static_cast<std::uint32_t>(number));
        }
        EXPECT_EQ(number, frames);
    }
}

TEST(FrameTap, of_a_run_ends_with_the_frame_that_failed_unless_one_is_lost)
{
    ExampleFrame frame;
    FrameTap sut(64);
    FrameDecoder decoder(kExampleShape);
    record(sut, frame, 0);
    frame.tools[0].sample_time_ns = 1;
    sut.record_failed({frame.input(), frame.queues, frame.devices});
    EXPECT_EQ(take_all(sut, decoder), (std::vector<std::int64_t>{0, 1}));
    EXPECT_FALSE(decoder.frame().has_hashes);
    EXPECT_EQ(decoder.frame().events.size(), frame.events.size());

    FrameTap full(2);
    record(full, frame, 0);
    full.record_failed({frame.input(), frame.queues, frame.devices});
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
                while (number - taken.load() > 4) // Within the capacity of the queue.
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
