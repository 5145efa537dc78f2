// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/shapes/shapes.hpp"
#include "platform/choices/device_choice.hpp"
#include "platform/choices/run_options.hpp"
#include "platform/choices/tool_choice.hpp"
#include "platform/devices/device_force.hpp"
#include "platform/devices/simulated/device_classes.hpp"
#include "platform/devices/simulated/replay_device.hpp"
#include "platform/readers/file_readers.hpp"
#include "platform/report/report.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "tests/shared/test_model.hpp"
#include "tests/unit/recording/recorded_example.hpp"
#include "transport/store/store_link.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <utility>

namespace tactus::hrtc::test
{
namespace
{

TEST(ToolChoice, takes_shapes_by_their_measures)
{
    EXPECT_TRUE(std::holds_alternative<PointCore>(parse_tool("point").value().core));
    EXPECT_EQ(parse_tool("point").value().radius_m, 0.0);
    EXPECT_EQ(parse_tool("sphere:0.002").value().radius_m, 0.002);
    const ToolChoice capsule = parse_tool("capsule:0.002,0.05").value();
    EXPECT_EQ(capsule.radius_m, 0.002);
    EXPECT_EQ(std::get<Segment>(capsule.core).from, Vec3(0.0, 0.0, -0.025));
    EXPECT_EQ(std::get<Segment>(capsule.core).to, Vec3(0.0, 0.0, 0.025));
    const ToolChoice box = parse_tool("box:0.01,0.02,0.03,0.001").value();
    EXPECT_EQ(std::get<Box>(box.core).half, Vec3(0.005, 0.01, 0.015));
    EXPECT_EQ(box.radius_m, 0.001);
    EXPECT_EQ(parse_tool("box:0.01,0.02,0.03").value().radius_m, 0.0);
    EXPECT_EQ(box.words, "box:0.01,0.02,0.03,0.001");
}

TEST(ToolChoice, takes_names_with_commas_and_a_radius_behind_the_last_one)
{
    const ToolChoice hull = parse_tool("hull:a,b.obj,0.001").value();
    EXPECT_EQ(hull.hull_file, "a,b.obj");
    EXPECT_EQ(hull.radius_m, 0.001);
    EXPECT_EQ(parse_tool("hull:a,b.obj").value().hull_file, "a,b.obj");
    const ToolChoice mesh = parse_tool("mesh:probe@0123,0").value();
    EXPECT_EQ(mesh.mesh_model, "probe@0123");
    EXPECT_EQ(mesh.radius_m, 0.0);
}

TEST(ToolChoice, is_a_sphere_within_the_range_by_default)
{
    EXPECT_EQ(default_tool(0.2).radius_m, 0.002);
    EXPECT_EQ(default_tool(0.2).words, "sphere:0.002");
    EXPECT_TRUE(parse_tool(default_tool(1e6).words));
    EXPECT_TRUE(parse_tool(default_tool(1e-6).words));
}

TEST(ToolChoice, reaches_as_far_as_its_farthest_point)
{
    EXPECT_EQ(reach_m(parse_tool("point").value(), nullptr), 0.0);
    EXPECT_EQ(reach_m(parse_tool("sphere:0.25").value(), nullptr), 0.25);
    EXPECT_EQ(reach_m(parse_tool("capsule:0.25,0.5").value(), nullptr), 0.5);
    EXPECT_DOUBLE_EQ(reach_m(parse_tool("box:0.2,0.2,0.1,0.05").value(), nullptr), 0.2);
}

TEST(ToolChoice, is_held_where_it_touches)
{
    EXPECT_EQ(operator_radius_m(parse_tool("point").value(), nullptr, 0.3), 0.003);
    EXPECT_EQ(operator_radius_m(parse_tool("sphere:0.25").value(), nullptr, 0.3), 0.25);
    EXPECT_EQ(operator_radius_m(parse_tool("sphere:0.25").value(), nullptr, 0.2), 0.2);
    EXPECT_EQ(operator_radius_m(parse_tool("capsule:0.25,0.5").value(), nullptr, 0.3), 0.25);
}

/// Folder with files for one test.
struct ToolFiles : testing::Test
{
    /// Options of one tool, a hull from a file with this text.
    Options of_hull(const std::string& text)
    {
        return of("hull:" + folder_.write("hull.off", text).string());
    }
    static Options of(const std::string& tool)
    {
        Options options;
        options.readers = file_readers();
        options.models = {"cow"};
        options.objects = {{}};
        options.tools[0].shape = parse_tool(tool).value();
        return options;
    }
    static std::string refusal_of(Options options)
    {
        const auto error = take_tool_files(options);
        return error ? error->text : "";
    }

    tactus::test::TemporaryFolder folder_{"tool-files"};
};

TEST_F(ToolFiles, are_the_corners_of_a_hull_each_once)
{
    // Corner 3 equals corner 0.
    Options options = of_hull("OFF\n4 2 0\n0 0 0\n0.3 0 0\n0 0.4 0\n0 0 0\n3 0 1 2\n3 3 1 2\n");
    ASSERT_FALSE(take_tool_files(options));
    const ToolChoice& tool = *options.tools[0].shape;
    EXPECT_EQ(std::get<Hull>(tool.core).vertices().size(), 3U);
    EXPECT_EQ(reach_m(tool, nullptr), 0.4);
}

TEST_F(ToolFiles, may_be_flat_or_a_line)
{
    Options options = of_hull("OFF\n3 1 0\n0 0 0\n0.1 0 0\n0.2 0 0\n3 0 1 2\n");
    EXPECT_FALSE(take_tool_files(options));
}

TEST_F(ToolFiles, are_refused_by_name_when_they_hold_no_hull)
{
    std::string many = "OFF\n65 1 0\n";
    for (int i = 0; i < 65; ++i)
    {
        many += "0." + std::to_string(100 + i) + " 0 0\n";
    }
    EXPECT_NE(
        refusal_of(of_hull(many + "3 0 1 2\n")).find("65 corners; the hull of a tool has at most"),
        std::string::npos);
    EXPECT_NE(refusal_of(of_hull("OFF\n3 1 0\n0 0 0\n2 0 0\n0 1 0\n3 0 1 2\n")).find("is 2 m from"),
              std::string::npos);
    EXPECT_NE(refusal_of(of("hull:" + (folder_.path() / "none.obj").string())).find("none.obj"),
              std::string::npos);
}

TEST_F(ToolFiles, add_what_is_a_mesh_to_the_models_once)
{
    Options options = of("mesh:probe");
    options.tools.push_back(options.tools.front());
    ASSERT_FALSE(take_tool_files(options));
    EXPECT_EQ(options.models, (std::vector<std::string>{"cow", "probe"}));
    EXPECT_EQ(std::get<MeshCore>(options.tools[1].shape->core).model, ModelId{1});
    EXPECT_EQ(options.objects.size(), 1U);
}

TEST_F(ToolFiles, refuse_a_mesh_that_is_touched_as_well)
{
    EXPECT_NE(refusal_of(of("mesh:cow")).find("'cow' is the model of an object as well"),
              std::string::npos);
}

constexpr double kPerSquareMetre = 1e6;
constexpr double kWay_m = 1e-4; ///< Motion of a hand, beyond the radius.

ToolSpec tool_of(const ToolCore& core, double radius_m)
{
    ToolSpec tool;
    tool.core = core;
    tool.radius_m = radius_m;
    return tool;
}

TEST(Footprint, is_the_outline_of_the_core_and_what_is_in_reach_around_it)
{
    const double r = 0.01;
    const double aside = std::sqrt(std::pow(1.05 * r + kWay_m, 2) - r * r);
    const double disc = std::numbers::pi * aside * aside;
    const auto faces = [](const ToolCore& core, double radius_m)
    { return faces_under(tool_of(core, radius_m), kPerSquareMetre) / kPerSquareMetre; };
    EXPECT_DOUBLE_EQ(faces(PointCore{}, r), disc);
    EXPECT_DOUBLE_EQ(faces(Segment{{0, 0, -0.1}, {0, 0, 0.1}}, r), disc + 0.4 * aside);
    EXPECT_DOUBLE_EQ(faces(Box{{0.01, 0.03, 0.02}}, r), disc + 0.04 * 0.06 + 0.2 * aside);
    const std::array<Vec3, 4> corners{
        {{0.0, 0.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.2, 0.0}, {0.0, 0.0, 0.3}}};
    EXPECT_DOUBLE_EQ(faces(Hull::create(corners).value(), r), disc + 0.06 + 1.0 * aside);
    EXPECT_DOUBLE_EQ(faces(PointCore{}, 0.0), std::numbers::pi * kWay_m * kWay_m);
    EXPECT_EQ(faces(MeshCore{}, r), 0.0);
    EXPECT_EQ(faces_under(tool_of(PointCore{}, r), 0.0), 0.0);
}

TEST(Footprint, counts_the_faces_of_a_model_by_its_base_mesh)
{
    const tactus::test::TestModel& plate =
        tactus::test::test_model("plate-9k", make_shape(Shape::plate, 9'000).value(), 500);
    ServedModel served = serve_from_file(plate.path, "plate", {}).value();
    double area_m2 = 0.0;
    for (const tactus::test::Face& face : plate.faces)
    {
        const Vec3 corner = to_vec3(face[0]);
        area_m2 += 0.5 * (to_vec3(face[1]) - corner).cross(to_vec3(face[2]) - corner).norm();
    }
    const auto all = static_cast<double>(plate.faces.size());
    const FaceDensity density = face_density(served);
    const double per_m2 = density.per_m2;
    EXPECT_NEAR(per_m2, all / area_m2, 0.01 * per_m2);

    const ToolSpec tool = tool_of(PointCore{}, 0.02 * plate.diagonal_m);
    const Footprint once = footprint_of(tool, density, 1.0);
    EXPECT_EQ(once.faces, faces_under(tool, per_m2));
    EXPECT_GT(once.kept, once.faces);
    EXPECT_DOUBLE_EQ(footprint_of(tool, density, 0.5).faces, 4.0 * once.faces);
    const Footprint small_object = footprint_of(tool, density, 1e-4);
    EXPECT_EQ(small_object.faces, all) << "no more than there are";
    EXPECT_EQ(small_object.kept, all);

    served.base.clear();
    EXPECT_EQ(face_density(served).per_m2, 0.0);
    EXPECT_EQ(footprint_of(tool, face_density(served), 1.0).kept, 0.0);
}

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

struct RecordedMotion : testing::Test
{
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
