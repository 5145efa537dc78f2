// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/choices/device_choice.hpp"
#include "platform/choices/tool_choice.hpp"
#include "platform/devices/device_force.hpp"
#include "platform/devices/simulated/device_classes.hpp"
#include "platform/devices/simulated/replay_device.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "tests/shared/test_model.hpp"
#include "tests/unit/recording/recorded_example.hpp"

#include <gtest/gtest.h>

#include <array>
#include <span>
#include <string>
#include <utility>

namespace tactus::hrtc::test
{

namespace
{

TEST(DeviceChoice, takes_a_simulated_device_of_each_class)
{
    const auto force_and_mass_of = [](std::string_view text)
    {
        const auto choice = parse_device(text);
        EXPECT_TRUE(choice.has_value() && choice.value().kind == DeviceKind::simulated) << text;
        return std::pair(choice.value().limits.force_max_n, choice.value().limits.mass_kg);
    };
    EXPECT_EQ(force_and_mass_of("sim"), std::pair(8.0, 0.1));
    EXPECT_EQ(force_and_mass_of("sim:touch"), std::pair(3.3, 0.045));
    EXPECT_EQ(force_and_mass_of("sim:omega"), std::pair(12.0, 0.2));
    EXPECT_EQ(force_and_mass_of("sim:delta"), std::pair(20.0, 0.25));
}

TEST(DeviceChoice, takes_places_of_devices_that_are_not_simulated)
{
    const auto udp = parse_device("udp:192.0.2.1:50000");
    ASSERT_TRUE(udp.has_value());
    EXPECT_EQ(udp.value().kind, DeviceKind::udp);
    EXPECT_EQ(udp.value().address, "192.0.2.1");
    EXPECT_EQ(udp.value().port, 50'000);
    const auto dhd = parse_device("dhd:63");
    ASSERT_TRUE(dhd.has_value());
    EXPECT_EQ(dhd.value().kind, DeviceKind::dhd);
    EXPECT_EQ(dhd.value().index, 63);
    const auto replay = parse_device("replay:a:b.rec");
    ASSERT_TRUE(replay.has_value());
    EXPECT_EQ(replay.value().kind, DeviceKind::replay);
    EXPECT_EQ(replay.value().recording, "a:b.rec");
    const auto plugin = parse_device("plugin:/a/b.so,/dev/x,9600");
    ASSERT_TRUE(plugin.has_value());
    EXPECT_EQ(plugin.value().kind, DeviceKind::plugin);
    EXPECT_EQ(plugin.value().library, "/a/b.so");
    EXPECT_EQ(plugin.value().words, "/dev/x,9600");
    EXPECT_EQ(parse_device("plugin:/b.so").value().words, "");
}

TEST(DeviceChoice, refuses_what_is_no_device)
{
    for (const char* text : {"", "simulated", "sim:", "sim:Touch", "sim:touch ", "sim:sigma",
                             "udp:80", "udp:", "dhd:64", "dhd:-1", "replay", "replay:", "plugin",
                             "plugin:", "plugin:,/a", "plugin:b.so", "plugin:./b.so"})
    {
        EXPECT_FALSE(parse_device(text).has_value()) << text;
    }
}

TEST(DeviceLimitsText, sets_what_it_names_and_nothing_else)
{
    DeviceLimits limits = kDeskClass;
    EXPECT_EQ(set_device_limits("mass_kg=0.2,rotation.inertia_kg_m2=3e-4,delay_s=0", limits), "");
    DeviceLimits wanted = kDeskClass;
    wanted.mass_kg = 0.2;
    wanted.rotation.inertia_kg_m2 = 3e-4;
    EXPECT_EQ(limits, wanted);
}

TEST(DeviceLimitsText, has_a_key_for_each_number)
{
    DeviceLimits limits = kDeskClass;
    EXPECT_EQ(set_device_limits("mass_kg=1,damping_n_s_per_m=2,friction_n=3,quantum_m=4,"
                                "delay_s=0.05,force_max_n=6,slew_max_n_per_s=7,"
                                "stiffness_max_n_per_m=8,added_damping_max_n_s_per_m=9,"
                                "rotation.torque_max_nm=10,rotation.inertia_kg_m2=11,"
                                "rotation.damping_nm_s_per_rad=12,rotation.friction_nm=13,"
                                "rotation.quantum_rad=14,rotation.slew_max_nm_per_s=15,"
                                "rotation.stiffness_max_nm_per_rad=16,"
                                "rotation.added_damping_max_nm_s_per_rad=17",
                                limits),
              "");
    const RotationLimits turn{true, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0, 16.0, 17.0};
    EXPECT_EQ(limits, (DeviceLimits{1.0, 2.0, 3.0, 4.0, 0.05, 6.0, 7.0, 8.0, 9.0, turn}));
}

TEST(DeviceLimitsText, changes_nothing_when_it_refuses)
{
    for (const auto& [text, fault] :
         {std::pair("", "is not KEY=VALUE; the keys are mass_kg, "),
          std::pair("mass_kg", "'mass_kg' is not KEY=VALUE"),
          std::pair("friction_n=1,", "'' is not KEY=VALUE"),
          std::pair("friction_n=1,mass=2", "'mass=2' is not KEY=VALUE"),
          std::pair("inertia_kg_m2=1", "rotation.inertia_kg_m2"),
          std::pair("mass_kg=", "mass_kg: '' is not a number"),
          std::pair("mass_kg=1kg", "mass_kg: '1kg' is not a number"),
          std::pair("mass_kg=nan", "mass_kg: 'nan' is not a number"),
          std::pair("mass_kg=1,mass_kg=1", "mass_kg is given twice"),
          std::pair("friction_n=1,mass_kg=0", "mass_kg must be finite and > 0"),
          std::pair("force_max_n=2000", "force_max_n must be at most 1000"),
          std::pair("delay_s=1", "delay_s must be at most 0.1"),
          std::pair("rotation.inertia_kg_m2=0", "inertia_kg_m2 must be finite and > 0")})
    {
        DeviceLimits limits = kDeskClass;
        EXPECT_NE(set_device_limits(text, limits).find(fault), std::string::npos)
            << text << ": " << set_device_limits(text, limits);
        EXPECT_EQ(limits, kDeskClass) << text;
    }
}

TEST(DeviceChoice, takes_faults_of_each_kind)
{
    int kind = 0;
    for (const char* text : {"jitter@0+1", "dropout@7+1000000000", "stuck@1000000000+3", "nan@12+4",
                             "time_jump@12+4", "disconnect@12+4"})
    {
        const std::optional<DeviceFault> fault = parse_device_fault(text);
        ASSERT_TRUE(fault.has_value()) << text;
        EXPECT_EQ(static_cast<int>(fault->kind), kind++);
    }
    const std::optional<DeviceFault> fault = parse_device_fault("dropout@7+1000000000");
    EXPECT_EQ(fault->begin_frame, 7U);
    EXPECT_EQ(fault->frames, 1'000'000'000U);
}

TEST(DeviceChoice, refuses_what_is_no_fault)
{
    for (const char* text :
         {"", "@", "@+", "nan", "nan@", "nan@1", "nan@1+", "nan@+1", "nan@1+0", "nan@-1+1",
          "nan@1+1000000001", "nan@1000000001+1", "nan@1+1+", "nan+1@1", "NaN@1+1", " nan@1+1"})
    {
        EXPECT_FALSE(parse_device_fault(text).has_value()) << text;
    }
}

} // namespace

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
