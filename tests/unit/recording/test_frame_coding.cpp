// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/recording/recorded_example.hpp"
#include "tests/unit/rt_core/coded_bytes.hpp"

#include <gtest/gtest.h>

namespace tactus::test
{
namespace
{

const char* decode(const std::vector<std::byte>& bytes)
{
    FrameDecoder decoder(kExampleShape);
    ByteReader reader(bytes);
    return decoder.decode(reader);
}

/// As docs/recording.md lists them, put together without the encoder's help.
TEST(FrameCoding, writes_the_bytes_that_the_format_page_lists)
{
    const ExampleFrame frame;
    FrameEncoder sut;
    CodedBytes expected;
    expected.put(std::uint8_t{3});
    expected.put(0.5).put(-0.25).put(2.0).put(std::int64_t{77}).put(3U).put(std::uint8_t{3});
    for (const double entry : {0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0})
    {
        expected.put(entry);
    }
    for (int i = 0; i < 9; ++i)
    {
        expected.put(i % 4 == 0 ? 1.0 : 0.0);
    }
    expected.put(0.125).put(4.0).put(-8.0).put(1.5).put(std::int64_t{0}).put(std::int64_t{0});
    expected.put(21U);
    for (std::uint32_t budget = 11; budget <= 18; ++budget)
    {
        expected.put(budget);
    }
    expected.put(9U).put(std::uint16_t{2});
    expected.put(std::uint8_t{0}).put(static_cast<std::uint8_t>(ContentKind::chunk));
    expected.put(1U).put(2U).put(5U).put(std::uint64_t{0xF0F0});
    expected.put(std::uint8_t{1}).put(static_cast<std::uint8_t>(ContentKind::chunk));
    expected.put(1U).put(2U).put(6U).put(std::uint64_t{0xFFF0});
    expected.put(std::uint64_t{0x1234'5678'9ABC'DEF0ULL});
    const OutputHashes hashes = hash_output(frame.output());
    expected.put(hashes.tools).put(hashes.pairs).put(hashes.models).put(hashes.work);

    CodedBytes all;
    all.put(static_cast<std::uint32_t>(expected.bytes().size())).append(expected.bytes());
    EXPECT_EQ(frame.code(sut), all.bytes());
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
