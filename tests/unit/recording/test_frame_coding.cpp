// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/recording/recorded_example.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace tactus::test
{
namespace
{

/// Bytes as docs/recording.md lists them, put together without the encoder's help.
class ByHand
{
public:
    template <typename T>
    ByHand& add(T value)
    {
        const std::size_t at = bytes.size();
        bytes.resize(at + sizeof(T));
        std::memcpy(bytes.data() + at, &value, sizeof(T));
        return *this;
    }

    std::vector<std::byte> bytes;
};

std::vector<std::byte> with_size(const ByHand& body)
{
    ByHand all;
    all.add(static_cast<std::uint32_t>(body.bytes.size()));
    all.bytes.insert(all.bytes.end(), body.bytes.begin(), body.bytes.end());
    return all.bytes;
}

const char* decode(const std::vector<std::byte>& bytes)
{
    FrameDecoder decoder(kExampleShape);
    ByteReader reader(bytes);
    return decoder.decode(reader);
}

TEST(FrameCoding, writes_the_bytes_that_the_format_page_lists)
{
    const ExampleFrame frame;
    FrameEncoder sut;
    ByHand expected;
    expected.add(std::uint8_t{3});
    expected.add(0.5).add(-0.25).add(2.0).add(std::int64_t{77}).add(3U).add(std::uint8_t{3});
    for (const double entry : {0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0})
    {
        expected.add(entry);
    }
    for (int i = 0; i < 9; ++i)
    {
        expected.add(i % 4 == 0 ? 1.0 : 0.0);
    }
    expected.add(0.125).add(4.0).add(-8.0).add(1.5).add(std::int64_t{0}).add(std::int64_t{0});
    expected.add(21U);
    for (std::uint32_t budget = 11; budget <= 18; ++budget)
    {
        expected.add(budget);
    }
    expected.add(9U).add(std::uint16_t{2});
    expected.add(std::uint8_t{0}).add(static_cast<std::uint8_t>(ContentKind::chunk));
    expected.add(1U).add(2U).add(5U).add(std::uint64_t{0xF0F0});
    expected.add(std::uint8_t{1}).add(static_cast<std::uint8_t>(ContentKind::chunk));
    expected.add(1U).add(2U).add(6U).add(std::uint64_t{0xFFF0});
    expected.add(std::uint64_t{0x1234'5678'9ABC'DEF0ULL});
    const OutputHashes hashes = hash_output(frame.output());
    expected.add(hashes.tools).add(hashes.pairs).add(hashes.models).add(hashes.work);

    EXPECT_EQ(frame.code(sut), with_size(expected));
}

TEST(FrameCoding, gives_every_value_back)
{
    const ExampleFrame frame;
    FrameEncoder encoder;
    const std::vector<std::byte> bytes = frame.code(encoder);
    FrameDecoder sut(kExampleShape);
    ByteReader reader(bytes);

    ASSERT_EQ(sut.decode(reader), nullptr);

    const RecordedFrame& read = sut.frame();
    EXPECT_TRUE(reader.at_end());
    EXPECT_EQ(read.tools[0].position_m, frame.tools[0].position_m);
    EXPECT_EQ(read.tools[0].sample_time_ns, 77);
    EXPECT_EQ(read.tools[0].elapsed_periods, 3U);
    EXPECT_EQ(read.tools[0].rotation, frame.tools[0].rotation);
    EXPECT_EQ(read.poses[0].translation_m, frame.poses[0].translation_m);
    EXPECT_EQ(read.poses[0].rotation, frame.poses[0].rotation);
    EXPECT_EQ(read.poses[0].revision, 21U);
    EXPECT_EQ(read.budgets.splits, 11U);
    EXPECT_EQ(read.budgets.regions, 18U);
    EXPECT_EQ(read.doors[0].wish_room, 9U);
    ASSERT_EQ(read.doors[0].events.size(), 2U);
    EXPECT_EQ(read.doors[0].events[1].linked, 0xFFF0U);
    EXPECT_EQ(read.doors[0].events[1].kind, DoorEventKind::link_update);
    EXPECT_EQ(read.state_hashes[0], 0x1234'5678'9ABC'DEF0ULL);
    EXPECT_EQ(read.output, hash_output(frame.output()));
}

TEST(FrameCoding, repeats_poses_and_budgets_only_when_they_change)
{
    ExampleFrame frame;
    FrameEncoder encoder;
    std::vector<std::byte> bytes = frame.code(encoder);
    const std::size_t whole = bytes.size();
    const auto add = [&]
    {
        const std::vector<std::byte> more = frame.code(encoder);
        bytes.insert(bytes.end(), more.begin(), more.end());
        return whole - more.size();
    };

    EXPECT_EQ(add(), kObjectPoseBytes + kBudgetsBytes);
    frame.budgets.merges = 99;
    EXPECT_EQ(add(), kObjectPoseBytes);
    frame.poses[0].age_ns = 5;
    EXPECT_EQ(add(), kBudgetsBytes);

    FrameDecoder sut(kExampleShape);
    ByteReader reader(bytes);
    for (int i = 0; i < 4; ++i)
    {
        ASSERT_EQ(sut.decode(reader), nullptr);
    }
    EXPECT_EQ(sut.frame().budgets.merges, 99U);
    EXPECT_EQ(sut.frame().poses[0].age_ns, 5);
}

TEST(FrameCoding, holds_the_largest_frame_there_can_be)
{
    ToolState turned;
    turned.rotation = -Mat3::Identity();
    const std::vector<ToolState> tools(kMaxTools, turned);
    const std::vector<ObjectPose> poses(kMaxObjects);
    const std::vector<DoorEvent> events(kMaxDoorEvents,
                                        DoorEvent{{ContentKind::chunk, 1}, 0, 0, 1});
    const std::vector<DoorTake> doors(kMaxModels, DoorTake{events, 0});
    const std::vector<ModelOutput> models(kMaxModels);
    FrameOutput output;
    output.door = doors;
    output.models = models;
    FrameEncoder encoder;

    const auto coded = encoder.encode(tools, poses, {}, output);

    EXPECT_EQ(coded.size(), kMaxCodedFrameBytes);
    FrameDecoder sut({kMaxTools, kMaxObjects, kMaxModels});
    ByteReader reader(coded);
    EXPECT_EQ(sut.decode(reader), nullptr);
}

TEST(FrameCoding, refuses_values_that_no_frame_can_have)
{
    constexpr std::size_t kFlags = 4;
    constexpr std::size_t kPose = kFlags + 1 + kToolStateBytes;
    constexpr std::size_t kValid = kPose - 9 * sizeof(double) - 1;
    constexpr std::size_t kScale = kPose + 12 * sizeof(double);
    constexpr std::size_t kBudgets = kPose + kObjectPoseBytes;
    constexpr std::size_t kEvents = kBudgets + kBudgetsBytes + 4;
    constexpr std::size_t kEvent = kEvents + 2;
    struct Case
    {
        std::size_t at;
        std::vector<unsigned> bytes;
        const char* said;
    };
    const std::vector<Case> cases{{kFlags, {4}, "flags"},
                                  {kFlags, {2}, "flags"}, // The first frame has both.
                                  {kValid, {4}, "validity"},
                                  {kPose + 6, {0xF0, 0x7F}, "pose"}, // Infinity.
                                  {kScale, {0, 0, 0, 0, 0, 0, 0, 0}, "scale"},
                                  {kBudgets, {1, 1}, "256 splits"},
                                  {kBudgets + 4, {1, 1}, "256 splits"},
                                  {kEvents, {0xFF, 0}, "128 events"},
                                  {kEvent, {2}, "unknown kind"},
                                  {kEvent + 1, {7}, "unknown kind"}};
    for (const Case& wrong : cases)
    {
        const ExampleFrame frame;
        FrameEncoder encoder;
        std::vector<std::byte> bytes = frame.code(encoder);
        for (std::size_t i = 0; i < wrong.bytes.size(); ++i)
        {
            bytes[wrong.at + i] = static_cast<std::byte>(wrong.bytes[i]);
        }
        const char* fault = decode(bytes);
        ASSERT_NE(fault, nullptr) << wrong.said;
        EXPECT_NE(std::string(fault).find(wrong.said), std::string::npos) << fault;
    }
}

} // namespace
} // namespace tactus::test
