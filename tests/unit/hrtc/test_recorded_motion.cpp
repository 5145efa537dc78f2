// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/recorded_motion.hpp"
#include "platform/devices/device_force.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "tests/shared/test_model.hpp"
#include "tests/unit/recording/recorded_example.hpp"

#include <gtest/gtest.h>

#include <array>
#include <span>
#include <string>

namespace tactus::hrtc::test
{

namespace
{

/// State of tool `tool` in frame `frame`; the third reading of each is invalid.
ToolState state_of(int tool, int frame)
{
    return {Vec3(tool, frame, 0.25), 1'000 * (tool + 1) + frame, 1, frame != 2};
}

/// Recording of two tools, of 8 and 3 N, at 4 kHz.
std::vector<std::byte> recording_of(int frames)
{
    tactus::test::RigOptions options = tactus::test::with_room_for_all();
    options.tools = {{0.01, 500.0, 8.0, 1.0}, {0.01, 500.0, 3.0, 1.0}};
    options.period_ns = 250'000;
    options.record = true;
    tactus::test::FrameRig rig(tactus::test::small_model(0), options);
    for (int frame = 0; frame < frames; ++frame)
    {
        rig.step(std::array{state_of(0, frame), state_of(1, frame)}, Budgets{});
    }
    return rig.finish_recording();
}

class RecordedMotion : public testing::Test
{
protected:
    [[nodiscard]] std::string write(std::span<const std::byte> bytes) const
    {
        return folder_.write("run.rec", bytes).string();
    }

private:
    tactus::test::TemporaryFolder folder_{"recorded-motion"};
};

TEST_F(RecordedMotion, is_that_of_the_tool_of_the_same_number_or_of_the_first)
{
    const std::string path = write(recording_of(5));
    for (const std::size_t tool : {0U, 1U, 2U, 63U})
    {
        const auto sut = read_recorded_motion(path, tool);
        ASSERT_TRUE(sut) << sut.error().text;
        const int played = tool == 1 ? 1 : 0;
        EXPECT_EQ(sut.value().rate_hz, 4'000);
        EXPECT_EQ(sut.value().limits.force_max_n, played == 1 ? 3.0 : 8.0);
        ASSERT_EQ(sut.value().readings.size(), 5U);
        for (int frame = 0; frame < 5; ++frame)
        {
            const DeviceSample& reading = sut.value().readings[static_cast<std::size_t>(frame)];
            EXPECT_EQ(to_vec3(reading.position_world_m), state_of(played, frame).position_m);
            EXPECT_FALSE(reading.rotation_world);
            EXPECT_EQ(reading.time.ns, state_of(played, frame).sample_time_ns);
            EXPECT_EQ(reading.valid, frame != 2);
        }
    }
}

/// All device data, and the hand's place while a clutch separated hand and tool.
TEST_F(RecordedMotion, is_the_hands_with_all_that_its_device_told)
{
    const auto model = tactus::test::make_tiny_model({});
    const tactus::test::ExampleFrame frame;
    RecordingWriter writer(tactus::test::example_setup(model));
    writer.add_piece(0, {ContentKind::chunk, 1}, model.piece({ContentKind::chunk, 1}));
    FrameEncoder encoder;
    writer.add_frame(frame.code(encoder));
    writer.finish(kNoFrame);
    const auto sut = read_recorded_motion(write(writer.take_bytes()), 0);
    ASSERT_TRUE(sut) << sut.error().text;
    EXPECT_EQ(sut.value().limits.rotation.torque_max_nm, 0.25);
    const DeviceSample& reading = sut.value().readings.at(0);
    EXPECT_EQ(reading.position_world_m, (std::array{31.0, 32.0, 33.0}));
    EXPECT_EQ(reading.rotation_world, (std::array{0.0, 0.0, 0.0, 1.0}));
    EXPECT_EQ(reading.velocity_world_m_per_s, (std::array{34.0, 35.0, 36.0}));
    EXPECT_EQ(reading.angular_velocity_world_rad_per_s, (std::array{37.0, 38.0, 39.0}));
    EXPECT_EQ(reading.buttons, 40U);
    EXPECT_EQ(reading.gripper_m, 41.0);
}

TEST_F(RecordedMotion, without_frames_is_empty)
{
    const auto sut = read_recorded_motion(write(recording_of(0)), 0);
    ASSERT_TRUE(sut) << sut.error().text;
    EXPECT_TRUE(sut.value().readings.empty());
}

TEST_F(RecordedMotion, refuses_what_is_no_recording_with_its_name)
{
    std::vector<std::byte> bytes = recording_of(5);
    bytes.pop_back();
    const auto cut = read_recorded_motion(write(bytes), 0);
    ASSERT_TRUE(cut) << cut.error().text;
    EXPECT_EQ(cut.value().readings.size(), 5U) << "all that is whole";
    bytes.resize(30);
    const std::string path = write(bytes);
    const auto refused = read_recorded_motion(path, 0);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().text.rfind(path, 0), 0U) << refused.error().text;
    EXPECT_FALSE(read_recorded_motion(path + ".missing", 0));
}

} // namespace

} // namespace tactus::hrtc::test
