// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/unit/recording/recorded_example.hpp"
#include "tests/unit/rt_core/coded_bytes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

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

/// Bytes as docs/recording.md lists them, assembled without the encoder.
TEST(FrameCoding, writes_the_bytes_that_the_format_page_lists)
{
    const ExampleFrame frame;
    FrameEncoder sut;
    CodedBytes expected;
    expected.put(std::uint8_t{3}).put(std::int64_t{123'456'789});
    expected.put(0.5).put(-0.25).put(2.0).put(std::int64_t{77}).put(3U).put(std::uint16_t{8191});
    for (const double entry : {0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0})
    {
        expected.put(entry);
    }
    expected.put(31.0).put(32.0).put(33.0);
    for (int i = 0; i < 9; ++i)
    {
        expected.put(i % 4 == 0 ? 1.0 : 0.0);
    }
    expected.put(34.0).put(35.0).put(36.0).put(37.0).put(38.0).put(39.0).put(40U).put(41.0);
    expected.put(42.0).put(43.0).put(44.0).put(45.0).put(46.0).put(47.0).put(48.0);
    const auto put_pose = [&expected]
    {
        for (int i = 0; i < 9; ++i)
        {
            expected.put(i % 4 == 0 ? 1.0 : 0.0);
        }
        expected.put(0.125).put(4.0).put(-8.0).put(1.5).put(std::int64_t{0}).put(std::int64_t{0});
        expected.put(21U);
    };
    expected.put(std::uint8_t{3}).put(std::uint8_t{1}).put(0U).put(0U);
    put_pose();
    expected.put(std::uint8_t{0}).put(1U).put(7U).put(0U);
    const auto put_material = [&expected]
    { expected.put(300.0).put(0.4).put(0.3).put(0.5).put(0.6).put(1e-5).put(1e-3); };
    put_material();
    put_pose();
    expected.put(std::uint8_t{5}).put(1U).put(7U);
    put_material();
    for (std::uint32_t budget = 11; budget <= 20; ++budget)
    {
        expected.put(budget);
    }
    expected.put(9U).put(std::uint16_t{2});
    expected.put(std::uint8_t{0}).put(static_cast<std::uint8_t>(ContentKind::chunk));
    expected.put(std::uint8_t{0}).put(1U).put(2U).put(5U).put(std::uint64_t{0xF0F0});
    expected.put(std::uint8_t{1}).put(static_cast<std::uint8_t>(ContentKind::chunk));
    expected.put(std::uint8_t{0}).put(1U).put(2U).put(6U).put(std::uint64_t{0xFFF0});
    expected.put(std::uint64_t{0x1234'5678'9ABC'DEF0ULL});
    const OutputHashes hashes = hash_output(frame.output());
    expected.put(hashes.tools).put(hashes.pairs).put(hashes.models).put(hashes.work);

    CodedBytes all;
    all.put(static_cast<std::uint32_t>(expected.bytes().size())).append(expected.bytes());
    EXPECT_EQ(frame.code(sut), all.bytes());
}

TEST(FrameCoding, repeats_budgets_only_when_they_change)
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

    EXPECT_EQ(add(), kBudgetsBytes);
    frame.budgets.merges = 99;
    EXPECT_EQ(add(), 0U);
    frame.changes[0].pose.arrival_ns = 5;
    EXPECT_EQ(add(), kBudgetsBytes);

    FrameDecoder sut(kExampleShape);
    ByteReader reader(bytes);
    for (int i = 0; i < 4; ++i)
    {
        ASSERT_EQ(sut.decode(reader), nullptr);
    }
    EXPECT_EQ(sut.frame().budgets.merges, 99U);
    EXPECT_EQ(sut.frame().changes[0].pose.arrival_ns, 5);
}

TEST(FrameCoding, holds_the_largest_frame_there_can_be)
{
    ToolState turned;
    turned.rotation = -Mat3::Identity();
    const std::vector<ToolState> tools(kMaxTools, turned);
    std::vector<SceneChange> changes(kMaxSceneChanges);
    for (SceneChange& change : changes)
    {
        change.kind = SceneChangeKind::object_comes;
    }
    const std::vector<QueueEvent> events(kMaxQueueEvents,
                                         QueueEvent{{ContentKind::chunk, 1}, 0, 0, 1});
    const std::vector<ModelOutput> models(kMaxModels);
    FrameOutput output;
    output.queues = {events, 0};
    output.models = models;
    FrameEncoder encoder;
    const std::vector<FaceId> removed(kMaxEditFaces);
    const std::vector<AddedFace> added(kMaxEditFaces);
    const std::vector<SurfaceEdit> edits(kMaxEditsPerFrame,
                                         SurfaceEdit{ModelId{1}, 1, removed, added, {}});

    const std::vector<DeviceRecord> devices(kMaxTools, ExampleFrame().devices[0]);
    const auto coded = encoder.encode({tools, changes, {}, 0, edits}, output, devices);

    EXPECT_EQ(coded.size(), kMaxCodedFrameBytes);
    FrameDecoder sut({kMaxTools, kMaxModels});
    ByteReader reader(coded);
    EXPECT_EQ(sut.decode(reader), nullptr);
}

TEST(FrameCoding, gives_back_what_a_device_said_and_was_told_and_no_more)
{
    ExampleFrame frame;
    FrameEncoder encoder;
    std::vector<std::byte> bytes = frame.code(encoder);
    FrameDecoder sut(kExampleShape);
    ByteReader whole(bytes);
    ASSERT_EQ(sut.decode(whole), nullptr);
    const DeviceRecord& got = sut.frame().devices[0];
    EXPECT_EQ(got.pose->position_m, frame.devices[0].pose->position_m);
    EXPECT_EQ(got.gripper_m, 41.0);
    EXPECT_EQ(got.buttons, 40U);
    EXPECT_EQ(got.sent_nm, Vec3(45.0, 46.0, 47.0));
    EXPECT_TRUE(got.measures_rotation);

    frame.devices[0] = {};
    frame.devices[0].connected = false;
    frame.tools[0].rotation.setIdentity();
    bytes = frame.code(encoder);
    ByteReader bare(bytes);
    ASSERT_EQ(sut.decode(bare), nullptr);
    EXPECT_FALSE(got.connected);
    EXPECT_TRUE(got.deadman_held);
    EXPECT_FALSE(got.pose || got.velocity_m_per_s || got.angular_velocity_rad_per_s);
    EXPECT_FALSE(got.gripper_m || got.measures_rotation);
    EXPECT_EQ(got.buttons, 0U);
    EXPECT_EQ(got.sent_n, Vec3(0.0, 0.0, 0.0));
    EXPECT_EQ(got.sent_gripper_n, 0.0);
}

TEST(FrameCoding, refuses_values_that_no_frame_can_have)
{
    constexpr std::size_t kFlags = 4;
    constexpr std::size_t kChanges = kFlags + 1 + 8 + kToolStateBytes;
    constexpr std::size_t kValid = kFlags + 1 + 8 + 24 + 8 + 4;
    constexpr std::size_t kMove = 9 + kObjectPoseBytes;
    constexpr std::size_t kFeel = 9 + kObjectSpecBytes - 4; // This change names no model.
    constexpr std::size_t kBudgets = kChanges + 1 + kMove + kSceneChangeBytes + kFeel;
    constexpr std::size_t kEvents = kBudgets + kBudgetsBytes + 4;
    constexpr std::size_t kEvent = kEvents + 2;
    struct Case
    {
        std::size_t at;
        std::vector<unsigned> bytes;
        const char* said;
    };
    const std::vector<Case> cases{{kFlags, {16}, "flags"},
                                  {kFlags, {1}, "flags"},          // The first frame has budgets.
                                  {kValid, {0xFF, 0x3F}, "flags"}, // Unknown flag.
                                  {kChanges, {0}, "1 to 64 changes"},
                                  {kChanges, {65}, "1 to 64 changes"},
                                  {kChanges + 1, {6}, "unknown kind"},
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

/// Faces of an edit for the example's model.
struct ExampleEdit
{
    std::vector<FaceId> removed{FaceId{5}, FaceId{7}};
    std::vector<AddedFace> added{
        {3, 4, {{{1.0F, 2.0F, 3.0F}, {4.0F, 5.0F, 6.0F}, {7.0F, 8.0F, 9.0F}}}}};
    Aabb box{{-1.0F, -2.0F, -3.0F}, {10.0F, 20.0F, 30.0F}};

    [[nodiscard]] SurfaceEdit view(std::uint32_t revision) const
    {
        return {ModelId{0}, revision, removed, added, box};
    }
};

/// Bytes of the edits in a frame, as docs/recording.md lists them.
CodedBytes coded_edit(std::uint32_t revision)
{
    CodedBytes expected;
    expected.put(0U).put(revision).put(std::uint16_t{2}).put(std::uint16_t{1});
    for (const float coordinate : {-1.0F, -2.0F, -3.0F, 10.0F, 20.0F, 30.0F})
    {
        expected.put(coordinate);
    }
    expected.put(5U).put(7U).put(3U).put(4U);
    for (int i = 1; i <= 9; ++i)
    {
        expected.put(static_cast<float>(i));
    }
    return expected;
}

// Places of the edits in the example's frame.
constexpr std::size_t kEditsAt = 4 + 1 + 8 + kToolStateBytes + 1 + (9 + kObjectPoseBytes) +
                                 kSceneChangeBytes + (9 + kObjectSpecBytes - 4);

TEST(FrameCoding, edits_follow_the_changes_and_are_given_back)
{
    const ExampleEdit edit;
    ExampleFrame frame;
    FrameEncoder plain_encoder;
    const std::vector<std::byte> plain = frame.code(plain_encoder);
    frame.edits = {edit.view(8), edit.view(9)};
    FrameEncoder encoder;
    const std::vector<std::byte> bytes = frame.code(encoder);
    EXPECT_EQ(bytes[4], std::byte{11});
    CodedBytes expected;
    expected.put(std::uint8_t{2}).append(coded_edit(8).bytes()).append(coded_edit(9).bytes());
    const auto at = bytes.begin() + kEditsAt;
    const auto size = static_cast<std::ptrdiff_t>(expected.bytes().size());
    ASSERT_EQ(bytes.size(), plain.size() + expected.bytes().size());
    EXPECT_EQ(std::vector<std::byte>(at, at + size), expected.bytes());
    EXPECT_TRUE(std::equal(at + size, bytes.end(), plain.begin() + kEditsAt));

    FrameDecoder sut(kExampleShape);
    ByteReader reader(bytes);
    ASSERT_EQ(sut.decode(reader), nullptr);
    const RecordedFrame copy = sut.frame();
    ByteReader none(plain);
    ASSERT_EQ(sut.decode(none), nullptr);
    EXPECT_TRUE(sut.frame().input().edits.empty());
    const FrameInput input = copy.input();
    ASSERT_EQ(input.edits.size(), 2U);
    for (std::uint32_t i = 0; i < 2; ++i)
    {
        EXPECT_EQ(input.edits[i].model, ModelId{0});
        EXPECT_EQ(input.edits[i].revision, 8 + i);
        EXPECT_TRUE(std::ranges::equal(input.edits[i].removed, edit.removed));
        EXPECT_TRUE(std::ranges::equal(input.edits[i].added, edit.added));
        EXPECT_EQ(input.edits[i].removed_m, edit.box);
    }
}

TEST(FrameCoding, refuses_edits_that_no_frame_can_have_and_every_truncation)
{
    const ExampleEdit edit;
    ExampleFrame frame;
    frame.edits = {edit.view(1)};
    FrameEncoder encoder;
    const std::vector<std::byte> whole = frame.code(encoder);
    const auto expect_refused = [&](std::size_t at, const std::vector<unsigned>& wrong)
    {
        std::vector<std::byte> bytes = whole;
        for (std::size_t i = 0; i < wrong.size(); ++i)
        {
            bytes[at + i] = static_cast<std::byte>(wrong[i]);
        }
        const char* fault = decode(bytes);
        ASSERT_NE(fault, nullptr) << at;
        EXPECT_NE(std::string(fault).find("1 or 2 edits"), std::string::npos) << fault;
    };
    expect_refused(kEditsAt, {0});
    expect_refused(kEditsAt, {3});
    expect_refused(kEditsAt + 1, {1});               // The model.
    expect_refused(kEditsAt + 9, {1, 4});            // 1,025 removed faces.
    expect_refused(kEditsAt + 11, {1, 4});           // 1,025 added faces.
    expect_refused(kEditsAt + 13, {0, 0, 128, 127}); // The box begins at infinity.
    expect_refused(kEditsAt + 53, {0, 0, 192, 127}); // A corner is NaN.
    for (std::size_t size = 0; size < whole.size(); ++size)
    {
        std::vector<std::byte> cut(whole.begin(),
                                   whole.begin() + static_cast<std::ptrdiff_t>(size));
        EXPECT_NE(decode(cut), nullptr) << size;
        if (size >= 4)
        {
            const auto body = static_cast<std::uint32_t>(size - 4);
            std::memcpy(cut.data(), &body, sizeof(body));
            EXPECT_NE(decode(cut), nullptr) << size;
        }
    }
}

TEST(FrameCoding, of_a_frame_that_failed_says_what_it_was_given_and_nothing_follows)
{
    constexpr std::size_t kFlagsAt = 4;
    const ExampleFrame frame;
    FrameEncoder encoder;
    const std::vector<std::byte> whole = frame.code(encoder);
    const auto given = encoder.encode_given({frame.input(), frame.queues, frame.devices});
    std::vector<std::byte> bytes(given.begin(), given.end());
    EXPECT_EQ(bytes.size(), whole.size() - 8 - sizeof(OutputHashes));
    EXPECT_EQ(bytes[kFlagsAt], std::byte{7}) << "its budgets are told in any case";
    EXPECT_TRUE(
        std::equal(bytes.begin() + kFlagsAt + 1, bytes.end(), whole.begin() + kFlagsAt + 1));
    bytes.insert(bytes.end(), whole.begin(), whole.end());
    FrameDecoder decoder(kExampleShape);
    ByteReader reader(bytes);
    EXPECT_EQ(decoder.decode(reader), nullptr);
    EXPECT_FALSE(decoder.frame().has_hashes);
    EXPECT_STREQ(decoder.decode(reader), "has hashes, but the frame before has none");
}

} // namespace
} // namespace tactus::test
