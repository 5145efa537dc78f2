// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/controller/finished_run.hpp"
#include "platform/controller/session.hpp"
#include "platform/recording/frame_decoder.hpp"
#include "platform/recording/recording.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "tests/shared/test_model.hpp"
#include "tests/unit/world/world_rig.hpp"
#include "transport/dds/domain.hpp"
#include "transport/dds/telemetry.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

/// Worlds in a loop of one's own.
namespace tactus::test
{
namespace
{

constexpr double kRounding_n = 1e-9;
/// Domain of no other test.
constexpr std::uint32_t kViewedDomain = 207;
/// Rounding of the cube to the grid of its model.
constexpr double kGrid_m = 2e-6;

TEST(World, a_sphere_on_a_cube_feels_the_spring_of_the_wall)
{
    World world;
    const WorldObject part = world.add(cube());
    ASSERT_TRUE(part) << part.error();
    const Hand hand = world.add(sphere(kRadius_m));
    ASSERT_TRUE(hand) << hand.error();
    EXPECT_EQ(hand.state().withheld, Withheld::no_frame);

    const HandState state = press(hand, kRadius_m - kPress_m);
    EXPECT_TRUE(state.in_contact);
    EXPECT_EQ(state.withheld, Withheld::nothing);
    EXPECT_NEAR(state.force_n[2], WorldOptions{}.stiffness_n_per_m * kPress_m,
                WorldOptions{}.stiffness_n_per_m * kGrid_m);
    EXPECT_NEAR(state.force_n[0], 0.0, kRounding_n);
    EXPECT_NEAR(state.proxy_m[2], kTop_m + kRadius_m, kGrid_m);
    ASSERT_EQ(state.contact_count, 1U);
    EXPECT_EQ(state.contacts[0].object, part.number());
    EXPECT_TRUE(state.contacts[0].is_touched);
    EXPECT_NEAR(state.contacts[0].on_object_m[2], kTop_m, kGrid_m);
    EXPECT_LE(state.contacts[0].lower_m, kRadius_m + 1e-9);
    EXPECT_GE(state.contacts[0].upper_m, kRadius_m - 1e-9);
    EXPECT_EQ(hand.why(state), "");
    EXPECT_EQ(std::bit_cast<std::uint64_t>(hand.state().force_n[2]),
              std::bit_cast<std::uint64_t>(state.force_n[2]));
    EXPECT_EQ(world.counts().frames, 600U);
}

TEST(World, the_forces_are_those_of_hrtc_on_a_recorded_motion_to_the_bit)
{
    const TestModel& model = small_model(0);
    const TemporaryFolder folder("world");
    hrtc::Options options;
    options.transport = hrtc::TransportKind::file;
    options.models = {model.path.string()};
    options.objects.resize(1);
    options.duration_s = 2.0;
    options.virtual_time = true;
    options.thread.is_realtime = false;
    options.thread.lock_memory = false;
    options.thread.processors_awake = false;
    options.record_path = (folder.path() / "hand.rec").string();
    const auto run_as_hrtc = [&options]
    {
        auto session = hrtc::Session::open(options);
        ASSERT_TRUE(session) << session.error().text;
        ASSERT_TRUE(session.value()->run("touch"));
    };
    run_as_hrtc();
    // The recorded motion is played to hrtc, and to a World.
    options.tools[0].device.kind = hrtc::DeviceKind::replay;
    options.tools[0].device.recording = options.record_path;
    options.record_path = (folder.path() / "again.rec").string();
    run_as_hrtc();
    const auto recording = Recording::read(options.record_path);
    ASSERT_TRUE(recording) << recording.error().text;

    World sut;
    static_cast<void>(sut.add(model_file(model.path.string())));
    const Hand felt = sut.add(sphere(recording.value().setup().tools[0].radius_m),
                              device("replay:" + options.tools[0].device.recording));
    ASSERT_TRUE(felt) << felt.error();

    FrameDecoder decoder(recording.value().shape());
    ByteReader frames(recording.value().frames());
    std::uint64_t touching = 0;
    constexpr std::uint64_t kFade = 60; // The last frames of a run fade the force.
    for (std::uint64_t frame = 0; frame + kFade < recording.value().frame_count(); ++frame)
    {
        ASSERT_EQ(decoder.decode(frames), nullptr);
        ASSERT_TRUE(sut.step());
        const Vec3& expected_n = decoder.frame().devices[0].sent_n;
        const HandState state = felt.state();
        for (int axis = 0; axis < 3; ++axis)
        {
            ASSERT_EQ(std::bit_cast<std::uint64_t>(state.force_n[static_cast<std::size_t>(axis)]),
                      std::bit_cast<std::uint64_t>(expected_n[axis]))
                << "frame " << frame << ", axis " << axis;
        }
        touching += expected_n.norm() > 0.0 ? 1U : 0U;
    }
    EXPECT_GT(touching, 300U);
}

TEST(World, a_missed_period_counts_and_a_stall_fades_the_force)
{
    World world;
    static_cast<void>(world.add(cube()));
    const Hand hand = world.add(sphere(kRadius_m));
    const double pressed_n = press(hand, kRadius_m - kPress_m).force_n[2];
    const auto late = hand.step(above(kRadius_m - kPress_m), 0.2);
    ASSERT_TRUE(late) << late.error().text;
    EXPECT_TRUE(has_cause(late.value().causes, ForceOff::stall));
    EXPECT_NE(hand.why(late.value()).find("frames were missed"), std::string::npos);
    EXPECT_GT(world.counts().missed, 0U);
    HandState back = hold(hand, above(kRadius_m - kPress_m), 2'000);
    EXPECT_EQ(back.withheld, Withheld::nothing);
    EXPECT_NEAR(back.force_n[2], pressed_n, 1e-4);
}

TEST(World, objects_move_change_come_and_go_by_their_handles)
{
    World world({.objects_max = 2});
    const WorldObject part = world.add(cube());
    const Hand hand = world.add(sphere(kRadius_m));
    ASSERT_TRUE(part.move({.translation_m = {0.0, 0.0, -0.01}})); // Before the first frame.
    EXPECT_NEAR(press(hand, kRadius_m - 0.01 - kPress_m).force_n[2], 0.25, 1e-3);

    ASSERT_TRUE(part.feel({.stiffness_n_per_m = 100.0}));
    HandState state = hold(hand, above(kRadius_m - 0.01 - kPress_m), 300);
    EXPECT_NEAR(state.force_n[2], 0.05, 1e-3);

    ASSERT_TRUE(part.move({.translation_m = {0.0, 0.0, -0.03}}));
    state = hold(hand, above(kRadius_m - 0.01 - kPress_m), 300);
    EXPECT_FALSE(state.in_contact);

    // An object whose surface comes into the tool has no force until the tool is clear.
    const WorldObject second =
        world.add(part, {.pose = {.translation_m = {0.0, 0.0, -0.006}}, .name = "second"});
    ASSERT_TRUE(second) << second.error();
    for (int i = 0; i < 300 && state.withheld != Withheld::overlap; ++i)
    {
        state = hand.step(above(kRadius_m - 0.01 - kPress_m)).value();
    }
    EXPECT_EQ(state.withheld, Withheld::overlap);
    EXPECT_NE(hand.why(state).find("'second'"), std::string::npos);
    EXPECT_EQ(line_of(Result<Done, Refusal>(second.remove())), "");
    EXPECT_EQ(line_of(second.move({})), "move(): the object was removed");
    EXPECT_EQ(line_of(second.remove()), "remove(): the object was removed before");
    EXPECT_EQ(world.add(second).error(), "add(): the object was removed");
    const WorldObject third = world.add(part);
    ASSERT_TRUE(third) << third.error();
    const WorldObject fourth = world.add(part);
    EXPECT_FALSE(fourth);
    EXPECT_NE(fourth.error().find("objects_max: 2 objects are there"), std::string::npos);
}

TEST(World, a_tool_that_begins_inside_is_told_so)
{
    World world;
    static_cast<void>(world.add(cube()));
    const Hand hand = world.add(sphere(kRadius_m));
    HandState state = hold(hand, {{0.0, 0.0, 0.0}}, 50);
    EXPECT_TRUE(state.began_inside);
    EXPECT_NE(hand.why(state).find("began inside a closed object"), std::string::npos);
}

TEST(World, tools_of_all_shapes_are_taken)
{
    World world({.memory_mib = 16});
    static_cast<void>(world.add(cube()));
    const std::vector<std::array<double, 3>> corners{
        {0.0, 0.0, 0.0}, {0.01, 0.0, 0.0}, {0.0, 0.01, 0.0}, {0.0, 0.0, 0.01}};
    for (const WorldTool& tool : {point(), capsule(0.002, 0.02), box(0.01, 0.02, 0.03),
                                  hull(corners), mesh_tool(cube({.fit_diagonal_m = 0.01}))})
    {
        const Hand hand = world.add(tool);
        EXPECT_TRUE(hand) << hand.error();
    }
    EXPECT_TRUE(world.step()) << line_of(world.step());
}

TEST(World, a_scene_is_beside_a_mesh_tool_and_its_objects_are_shown_again)
{
    const TemporaryFolder folder("world-scene");
    std::filesystem::copy_file(small_model(0).path, folder.path() / "part.spm");
    const std::string path = (folder.path() / "scene.gltf").string();
    std::ofstream(path) << R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "one", "extras": {"tactus": {"model": "part.spm"}}}]})";
    World world({.memory_mib = 16, .objects_max = 2});
    const std::vector<WorldObject> objects = world.add_scene(path);
    ASSERT_EQ(objects.size(), 1U);
    ASSERT_TRUE(objects[0]) << objects[0].error();
    const Hand hand = world.add(mesh_tool(cube({.fit_diagonal_m = 0.01})));
    const auto felt = hand.step({{0.5, 0.5, 0.5}});
    ASSERT_TRUE(felt) << felt.error().text;
    const WorldObject again = world.add(objects[0]);
    EXPECT_TRUE(again) << again.error();
    EXPECT_TRUE(hand.step({{0.5, 0.5, 0.5}}));

    World early;
    EXPECT_EQ(early.add(early.add_scene(path).front()).error(),
              "add(): a World with a scene has no other objects at the start");
}

TEST(World, callbacks_may_not_call_their_world)
{
    const auto expect_refusal = [](const std::string& line)
    { EXPECT_NE(line.find("called from a callback or device of the World"), line.npos) << line; };
    std::vector<std::string> lines;
    World world;
    Hand hand;
    const WorldObject part = world.add(cube(
        {.unit = "mm", .progress = [&](double) { lines.push_back(world.add(cube()).error()); }}));
    ASSERT_TRUE(part) << part.error();
    EXPECT_FALSE(lines.empty());
    std::ranges::for_each(lines, expect_refusal);
    EXPECT_FALSE(world.error()) << "such a call is refused, the World goes on";
    const HandForce force = [&](const ToolState&, const ToolOutput&) -> ExternalForce
    {
        lines = {line_of(part.move({})),
                 line_of(part.feel({})),
                 line_of(part.remove()),
                 line_of(hand.hold({})),
                 line_of(hand.step({})),
                 line_of(world.step()),
                 line_of(world.start()),
                 line_of(world.stop()),
                 world.add(part).error(),
                 world.add_scene("table.gltf").front().error(),
                 world.add(cube()).error(),
                 world.error().value_or(Refusal{}).text,
                 line_of(part.carve(sphere(0.01), {}, {})),
                 line_of(part.fill(sphere(0.01), {}, {})),
                 line_of(part.displace({}, 0.01, {})),
                 line_of(part.save("part.spm"))};
        return {};
    };
    hand = world.add(sphere(kRadius_m), by_program(), {.force = force});
    const auto felt = hand.step(above(0.02));
    ASSERT_TRUE(felt) << felt.error().text;
    EXPECT_EQ(lines.size(), 16U);
    std::ranges::for_each(lines, expect_refusal);
    EXPECT_TRUE(world.stop());
}

TEST(World, wrong_parts_are_refused_in_one_line_and_the_world_does_not_begin)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    World parts;
    const auto refused = [](const auto& handle, const std::string& text)
    {
        EXPECT_FALSE(handle);
        EXPECT_NE(handle.error().find(text), std::string::npos) << handle.error();
        EXPECT_EQ(handle.error().find("--"), std::string::npos) << handle.error();
        EXPECT_EQ(handle.error().find('\n'), std::string::npos) << handle.error();
    };
    refused(parts.add(model_file("nowhere.spm")), "nowhere.spm: ");
    refused(parts.add(model_file("plate.stl")), "plate.stl: a mesh; add it by mesh_file()");
    refused(parts.add(mesh_file("nowhere.stl")), "nowhere.stl: ");
    refused(parts.add(cube({.unit = "feet"})), "unit: 'feet' is not m, cm, mm");
    refused(parts.add(cube({.name = "a/b"})), "name: 'a/b' is not");
    refused(parts.add(mesh({{0.0, 0.0, 0.0}}, {{0, 1, 2}})), "face 0 names vertex 1; there are 1");
    refused(parts.add(cube({.progress = [](double) { throw std::runtime_error("no"); }})),
            "the progress callback has thrown: no");
    refused(parts.add(cube(), {.pose = {.scale = 0.0}}), "pose: scale is out of range");
    refused(parts.add(cube(), {.material = {.static_friction = 4.0}}), "material: out of range");
    refused(parts.add(sphere(5.0)), "tool: 'sphere:5'");
    refused(parts.add(sphere(nan)), "tool: ");
    refused(parts.add(tool("ball:0.1")), "tool: 'ball:0.1'");
    refused(parts.add(hull({})), "a hull needs corners");
    refused(parts.add(sphere(0.01), device("omega")), "device: 'omega'");
    refused(parts.add(sphere(0.01), device("sim", {.frame = "0,0,0"})), "frame: ");
    refused(parts.add(sphere(0.01), by_program(), {.fixture = "spring"}), "fixture: 'spring'");
    refused(parts.add(tool("mesh:nowhere.spm")), "nowhere.spm: ");
    refused(parts.add(sphere(0.01), device(std::shared_ptr<HapticDevice>())),
            "device: neither words nor an object");
    World other;
    refused(parts.add(other.add(cube())), "add(): the handle is of no object of this World");
    refused(parts.add(WorldObject()), "add(): the handle is of no object of this World");
    EXPECT_NE(parts.add(model_file("no--where.spm")).error().find("no--where.spm: "),
              std::string::npos);
    EXPECT_EQ(line_of(parts.step()),
              "step(): the World has no hand; refused: " + parts.error()->text);
    EXPECT_EQ(line_of(parts.start()),
              "start(): the World has no hand; refused: " + parts.error()->text);

    EXPECT_EQ(line_of(World().step()), "step(): the World has no hand; add one first");
    World empty;
    const Hand alone = empty.add(sphere(0.01));
    EXPECT_EQ(line_of(empty.start()), "start(): the World has no object; add one first");
    EXPECT_EQ(line_of(alone.step({})), "step(): the World has no object; add one first");
    World fast({.rate_hz = 50});
    static_cast<void>(fast.add(cube()));
    static_cast<void>(fast.add(sphere(0.01)));
    EXPECT_EQ(line_of(fast.step()), "rate_hz: 50; 100 to 10000 is allowed");
    World smooth({.shading_m = 0.001});
    static_cast<void>(smooth.add(cube()));
    static_cast<void>(smooth.add(box(0.01, 0.01, 0.01)));
    EXPECT_EQ(line_of(smooth.step()), "shading_m: needs a point or a sphere as a tool");
    World real;
    static_cast<void>(real.add(cube()));
    static_cast<void>(real.add(sphere(0.01), device("udp")));
    EXPECT_EQ(line_of(real.step()), "step(): the device of hand 0 runs in real time; use start()");
    World small({.memory_mib = 0.25});
    static_cast<void>(small.add(model_file(small_model(0).path.string())));
    static_cast<void>(small.add(sphere(0.01)));
    EXPECT_NE(line_of(small.step()).find("memory_mib: 0.25 MiB is too small for 1 model"),
              std::string::npos);
}

TEST(World, a_refused_part_leaves_the_world_as_it_was)
{
    World world({.memory_mib = 16.0, .objects_max = 2});
    EXPECT_FALSE(world.add(model_file("nowhere.spm")));
    EXPECT_FALSE(world.add(published("cube"), {.edit_faces = 1}));
    const std::string path = small_model(0).path.string();
    EXPECT_FALSE(world.add(model_file(path), {.pose = {.scale = 0.0}}));
    EXPECT_FALSE(world.add(mesh_tool(model_file(path)), by_program(), {.fixture = "spring"}));
    EXPECT_TRUE(world.add(published("cube"))) << "a model of a refused part is still there";

    World other({.memory_mib = 16.0, .objects_max = 2});
    EXPECT_FALSE(other.add(model_file("nowhere.spm")));
    EXPECT_FALSE(other.add(published("cube"), {.edit_faces = 1}));
    EXPECT_FALSE(other.add(sphere(5.0)));
    const Hand hand = other.add(sphere(kRadius_m));
    EXPECT_NE(line_of(other.step()).find("step(): the World has no object; refused: nowhere.spm"),
              std::string::npos);
    const WorldObject part = other.add(cube());
    ASSERT_TRUE(part) << part.error();
    Hand last = hand;
    for (std::size_t i = 1; i <= kMaxTools; ++i)
    {
        last = other.add(sphere(kRadius_m));
    }
    EXPECT_EQ(last.error(), "a World has at most 16 hands");
    EXPECT_GT(press(hand, kRadius_m - kPress_m).force_n[2], 0.0);
    EXPECT_NE(other.error().value().text.find("nowhere.spm: "), std::string::npos);
    EXPECT_TRUE(other.add(part, {.pose = {.translation_m = {0.5, 0.0, 0.0}}}));
    EXPECT_NE(other.add(part).error().find("objects_max: "), std::string::npos);
    EXPECT_TRUE(hand.step(above(0.02)));
}

TEST(World, wrong_calls_are_refused_and_the_loop_goes_on)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    std::optional<World> world;
    world.emplace();
    const WorldObject part = world->add(cube());
    const Hand hand = world->add(sphere(kRadius_m));
    EXPECT_EQ(line_of(part.remove()),
              "remove(): an object leaves after the first frame; before it, don't add it");
    EXPECT_TRUE(hand.step(above(0.02)));
    EXPECT_NE(line_of(hand.step({{nan, 0.0, 0.0}})).find("position_m: "), std::string::npos);
    EXPECT_NE(line_of(hand.step({{}, {0.0, 0.0, 0.0, 2.0}})).find("rotation: "), std::string::npos);
    EXPECT_EQ(line_of(hand.step(above(0.02), -1.0)), "dt_s: -1; 0 or more is allowed");
    EXPECT_EQ(line_of(world->start()), "start(): the program runs this World by step()");
    EXPECT_FALSE(world->add(sphere(0.01)));
    EXPECT_EQ(world->add(cube()).error(),
              "the World runs; add each mesh before the first frame, and further objects of it by "
              "their handles");
    EXPECT_TRUE(hand.step(above(0.02))) << "a late refusal must not end the World";
    EXPECT_TRUE(world->stop());
    EXPECT_EQ(hand.state().withheld, Withheld::ended);
    EXPECT_EQ(line_of(hand.step(above(0.02))), "step(): the World has ended; make a new one");
    EXPECT_EQ(line_of(part.move({})), "move(): the World has ended; make a new one");
    EXPECT_EQ(world->add(part).error(), "add(): the World has ended; make a new one");
    world.reset();
    EXPECT_EQ(line_of(part.move({})), "the World of this handle is gone");
    EXPECT_EQ(line_of(hand.step({})), "the World of this handle is gone");
    EXPECT_EQ(hand.state().withheld, Withheld::ended);
    EXPECT_EQ(line_of(Hand().hold({})), "the World of this handle is gone");
}

TEST(World, each_reason_for_a_withheld_force_has_its_text)
{
    EXPECT_EQ(text_of(Withheld::nothing), "");
    EXPECT_EQ(withheld_by(ForceOff::none), Withheld::nothing);
    for (std::size_t bit = 0; bit < kForceOffs; ++bit)
    {
        const Withheld one = withheld_by(static_cast<ForceOff>(1U << bit));
        EXPECT_NE(text_of(one), "");
        EXPECT_NE(one, Withheld::nothing);
    }
    EXPECT_EQ(withheld_by(ForceOff::stall | ForceOff::disconnect), Withheld::disconnect);
}

/// The telemetry has the named objects, also those that are added later, where the hand's frames
/// have them.
TEST(World, shows_viewers_its_hands_and_objects_with_their_names)
{
    const auto viewer = std::move(dds::Domain::join({kViewedDomain, {}}, dds::Party::both)).value();
    const auto reader = std::move(dds::TelemetryReader::create(viewer)).value();
    World world({.objects_max = 2, .domain = kViewedDomain, .is_watched = true, .name = "seen"});
    const WorldObject first = world.add(cube(), {.name = "table"});
    const Hand hand = world.add(sphere(kRadius_m));
    ASSERT_TRUE(hand.step(above(0.1)));
    const WorldObject second =
        world.add(first, {.pose = {.translation_m = {0.5, 0.0, 0.0}}, .name = "cup"});
    ASSERT_TRUE(second) << second.error();
    const auto are_seen = [&]
    {
        reader->poll();
        return reader->controllers().size() == 1 &&
               reader->controllers()[0].objects.objects.size() == 2;
    };
    for (int i = 0; i < 100'000 && !are_seen(); ++i)
    {
        ASSERT_TRUE(hand.step(above(0.1)));
    }
    ASSERT_TRUE(are_seen());
    const dds::WatchedController& seen = reader->controllers()[0];
    EXPECT_EQ(seen.name, "seen");
    EXPECT_EQ(seen.telemetry.tools[0].position_m, above(0.1).position_m);
    EXPECT_EQ(seen.objects.objects[0].name, "table");
    EXPECT_EQ(seen.objects.objects[1].name, "cup");
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        EXPECT_NEAR(seen.objects.objects[0].pose.translation_m[axis], 0.0, 1e-12);
        EXPECT_NEAR(seen.objects.objects[1].pose.translation_m[axis], axis == 0 ? 0.5 : 0.0, 1e-12);
    }
}

} // namespace
} // namespace tactus::test
