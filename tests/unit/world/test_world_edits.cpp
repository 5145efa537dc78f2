// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/shapes/shapes.hpp"
#include "host_tools/spm_publish/edited_models.hpp"
#include "platform/choices/run_options.hpp"
#include "platform/controller/controller.hpp"
#include "platform/controller/run_hooks.hpp"
#include "platform/world/local_edits.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "tests/shared/test_model.hpp"
#include "tests/unit/world/world_rig.hpp"
#include "transport/dds/dds_server.hpp"
#include "transport/store/model_store.hpp"
#include "transport/store/store_link.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

/// Worlds whose models change while they are touched.
namespace tactus::test
{
namespace
{

using namespace std::chrono_literals;

constexpr std::uint32_t kRoom = 4'096;
constexpr double kWidth_m = 0.04; ///< Width of the hole below the hand.
constexpr double kDepth_m = 0.01;
constexpr double kLeft_m = 0.001; ///< Depth of the hole when it was filled.
/// Domain of no other test.
constexpr std::uint32_t kServedDomain = 208;
/// Some steps of the model's grid.
constexpr double kNear_m = 1e-5;

/// Cutter as wide as the hole, and as high as it is deep.
WorldTool cutter()
{
    return box(kWidth_m, kWidth_m, kDepth_m);
}

/// Sweep of the cutter from the air down to the hole's floor.
Result<double, Refusal> carve_hole(const WorldObject& object)
{
    return object.carve(cutter(), above(0.02), above(-0.5 * kDepth_m).position_m);
}

/// Fills the hole but for kLeft_m below the upper face, which is that of the model's box.
Result<double, Refusal> fill_hole(const WorldObject& object)
{
    const HandPose place = above(-kLeft_m - 0.5 * kDepth_m);
    return object.fill(cutter(), place, place.position_m);
}

constexpr double kHole_m3 = kWidth_m * kWidth_m * kDepth_m;

TEST(LocalEdits, a_model_whose_edit_a_frame_refused_gets_no_more)
{
    const TestModel& model = test_model("local-edits", make_shape(Shape::plate, 800).value());
    hrtc::Options options;
    options.models = {model.path};
    options.objects.resize(1);
    options.pool_mib = 4.0;
    std::vector<ServedModel> served;
    served.push_back(serve_from_file(model.path, "plate", {}).value());
    served.back().edit_room = kRoom;
    const auto controller =
        hrtc::Controller::create(options, std::move(served), {}, [] { return true; });
    ASSERT_TRUE(controller) << controller.error().text;
    auto made = hrtc::LocalEdits::create(*controller.value(), options);
    ASSERT_TRUE(made) << made.error().text;
    hrtc::LocalEdits& sut = *made.value();
    const auto dent = [](SurfaceEditor& editor) {
        return editor.displace({0.05, 0.05, 0.0}, 0.009, {0.0, 0.0, 0.0002});
    };
    const auto first = sut.change(0, dent);
    ASSERT_TRUE(first) << first.error().text;
    sut.step();
    EditMailbox& mailbox = *sut.ports().mailbox;
    ASSERT_EQ(mailbox.edits().size(), 1U);
    mailbox.done({});                 // A frame that did not make the edit tells this.
    EXPECT_TRUE(sut.change(0, dent)); // Not known yet.
    sut.step();
    const auto late = sut.change(0, dent);
    ASSERT_FALSE(late);
    EXPECT_NE(late.error().text.find("a frame has refused an edit"), std::string::npos);
}

TEST(WorldEdits, a_tool_loses_its_support_and_finds_the_floor_of_the_hole)
{
    World world;
    const WorldObject part = world.add(cube(), {.edit_faces = kRoom});
    const WorldObject other = world.add(part, {.pose = {.translation_m = {0.3, 0.0, 0.0}}});
    ASSERT_TRUE(other) << other.error();
    const Hand hand = world.add(sphere(kRadius_m));
    const Hand beside = world.add(sphere(kRadius_m));
    const auto beside_at = [](double height_m)
    {
        HandPose pose = above(height_m);
        pose.position_m[0] += 0.3;
        return pose;
    };
    ASSERT_TRUE(beside.hold(beside_at(0.02)));
    ASSERT_GT(press(hand, kRadius_m - kPress_m).force_n[2], 0.0);

    const auto carved = carve_hole(part);
    ASSERT_TRUE(carved) << carved.error().text;
    EXPECT_NEAR(carved.value(), kHole_m3, 1e-3 * kHole_m3);
    HandState state = hold(hand, above(kRadius_m - kPress_m), 200);
    EXPECT_FALSE(state.in_contact);
    EXPECT_EQ(state.force_n[2], 0.0);

    state = press(hand, kRadius_m - kDepth_m - kPress_m);
    EXPECT_NEAR(state.proxy_m[2], kTop_m - kDepth_m + kRadius_m, kNear_m);
    EXPECT_NEAR(state.force_n[2], WorldOptions{}.stiffness_n_per_m * kPress_m,
                WorldOptions{}.stiffness_n_per_m * kNear_m);
    for (int i = 1; i <= 600; ++i)
    {
        const double share = std::min(1.0, i / 450.0);
        state =
            beside.step(beside_at(0.02 - share * (0.02 + kDepth_m + kPress_m - kRadius_m))).value();
    }
    EXPECT_NEAR(state.proxy_m[2], kTop_m - kDepth_m + kRadius_m, kNear_m)
        << "all objects of the model have the hole";
}

TEST(WorldEdits, a_filled_hole_carries_again_and_corners_move)
{
    World world;
    const WorldObject part = world.add(cube(), {.edit_faces = kRoom});
    const Hand hand = world.add(sphere(kRadius_m));
    ASSERT_TRUE(hand.step(above(0.02)));
    ASSERT_TRUE(carve_hole(part));
    const auto filled = fill_hole(part);
    ASSERT_TRUE(filled) << filled.error().text;
    const double filled_m3 = kHole_m3 - kWidth_m * kWidth_m * kLeft_m;
    EXPECT_NEAR(filled.value(), filled_m3, 1e-3 * filled_m3);
    EXPECT_NEAR(press(hand, kRadius_m - kLeft_m - kPress_m).proxy_m[2],
                kTop_m - kLeft_m + kRadius_m, kNear_m);
    const auto moved = part.displace({0.05, 0.05, 0.05}, 0.01, {-0.002, -0.002, -0.002});
    ASSERT_TRUE(moved) << moved.error().text;
    EXPECT_LT(moved.value(), 0.0);
    EXPECT_GT(moved.value(), -0.1 * 0.1 * 0.006);
}

TEST(WorldEdits, a_saved_model_has_the_hole_and_a_higher_revision)
{
    const TemporaryFolder folder("world-edits");
    const std::string path = (folder.path() / "carved.spm").string();
    {
        World world;
        const WorldObject part = world.add(cube(), {.edit_faces = kRoom});
        const Hand hand = world.add(sphere(kRadius_m));
        EXPECT_EQ(line_of(part.save(path)), "save(): edits begin with the first frame");
        ASSERT_TRUE(hand.step(above(0.02)));
        ASSERT_TRUE(carve_hole(part));
        EXPECT_NE(line_of(part.save("/nowhere/carved.spm")), "");
        ASSERT_TRUE(world.stop());
        EXPECT_EQ(line_of(carve_hole(part)), "carve(): the World has ended; make a new one");
        const auto saved = part.save(path);
        ASSERT_TRUE(saved) << saved.error().text;
    }
    const auto store = ModelStore::open(path);
    ASSERT_TRUE(store) << store.error().text;
    EXPECT_EQ(store.value().revision(), 1U);
    World again;
    static_cast<void>(again.add(model_file(path)));
    const Hand hand = again.add(sphere(kRadius_m));
    EXPECT_NEAR(press(hand, kRadius_m - kDepth_m - kPress_m).proxy_m[2],
                kTop_m - kDepth_m + kRadius_m, kNear_m);
}

TEST(WorldEdits, a_tool_with_the_law_of_the_burr_sinks_in)
{
    const auto depth_with = [](const std::string& edit)
    {
        World world;
        static_cast<void>(world.add(cube(), {.edit_faces = kRoom}));
        const Hand hand = world.add(sphere(kRadius_m), by_program(), {.edit = edit});
        EXPECT_TRUE(hand) << hand.error();
        return kTop_m + kRadius_m - press(hand, kRadius_m - 0.004, 3'000).proxy_m[2];
    };
    EXPECT_NEAR(depth_with(""), 0.0, kNear_m);
    EXPECT_GT(depth_with("carve:5000"), 0.0003);
}

TEST(WorldEdits, a_tool_carves_the_model_of_a_server)
{
    const TemporaryFolder folder("world-served");
    const std::string path = (folder.path() / "cube.spm").string();
    {
        World local;
        const WorldObject part = local.add(cube(), {.edit_faces = 1});
        const Hand hand = local.add(sphere(kRadius_m));
        ASSERT_TRUE(hand.step(above(0.02)));
        ASSERT_TRUE(part.save(path));
    }
    std::vector<dds::PublishedModel> models;
    models.push_back({"cube", std::move(ModelStore::open(path)).value(), kRoom});
    auto server = dds::DdsServer::create(kServedDomain, std::move(models), {}, {},
                                         dds::Party::server, {true, {}});
    ASSERT_TRUE(server) << server.error().text;
    auto edited = EditedModels::create(*server.value(), {});
    ASSERT_TRUE(edited) << edited.error().text;
    std::atomic<bool> is_ending{false};
    std::thread serving(
        [&]
        {
            while (!is_ending.load())
            {
                server.value()->wait(1ms);
                server.value()->step();
                edited.value().step();
            }
        });
    {
        World world({.domain = kServedDomain});
        const WorldObject part = world.add(published("cube"));
        const Hand hand = world.add(sphere(kRadius_m), by_program(), {.edit = "carve:5000"});
        HandState state = press(hand, kRadius_m - 0.004);
        EXPECT_TRUE(state.in_contact);
        const auto depth_m = [&] { return kTop_m + kRadius_m - state.proxy_m[2]; };
        for (int i = 0; i < 60'000 && depth_m() < 0.0003; ++i)
        {
            state = hand.step(above(kRadius_m - 0.004)).value();
            std::this_thread::sleep_for(1ms);
        }
        EXPECT_GE(depth_m(), 0.0003);
        EXPECT_EQ(line_of(carve_hole(part)),
                  "carve(): 'cube' is of a server, which edits it; use the hand's edit");
    }
    is_ending.store(true);
    serving.join();
    EXPECT_GT(edited.value().revision(0), 0U);
}

TEST(WorldEdits, the_guarded_loop_takes_edits_of_other_threads)
{
    World world({.allow_no_rt = true});
    const WorldObject part = world.add(cube(), {.edit_faces = kRoom});
    const Hand hand = world.add(sphere(kRadius_m));
    ASSERT_TRUE(hand.hold(above(kRadius_m + 0.001)));
    const auto started = world.start();
    ASSERT_TRUE(started) << started.error().text;
    const auto wait_for = [&](const char* event, double height_m, auto has_come)
    {
        for (int i = 0; i < 12'000 && !has_come(hand.state()); ++i)
        {
            ASSERT_TRUE(hand.hold(above(height_m)));
            std::this_thread::sleep_for(5ms);
        }
        ASSERT_TRUE(has_come(hand.state())) << event << " has not come";
    };
    wait_for("a touch", kRadius_m - kPress_m,
             [](const HandState& state) { return state.in_contact; });
    Result<double, Refusal> carved(Refusal{"not called"});
    std::thread([&] { carved = carve_hole(part); }).join();
    ASSERT_TRUE(carved) << carved.error().text;
    wait_for("the hole", kRadius_m - kDepth_m - kPress_m,
             [](const HandState& state)
             {
                 return state.in_contact &&
                        std::abs(state.proxy_m[2] - (kTop_m - kDepth_m + kRadius_m)) < kNear_m;
             });
    EXPECT_TRUE(world.stop());
}

TEST(WorldEdits, wrong_edits_are_refused_in_one_line_and_change_nothing)
{
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    std::optional<World> world;
    world.emplace(WorldOptions{.objects_max = 4});
    const WorldObject part = world->add(cube(), {.edit_faces = 16});
    const WorldObject stiff = world->add(cube({.unit = "mm", .name = "stiff"}),
                                         {.pose = {.translation_m = {0.3, 0.0, 0.0}}});
    const Hand hand = world->add(sphere(kRadius_m));
    EXPECT_EQ(line_of(carve_hole(part)), "carve(): edits begin with the first frame");
    ASSERT_TRUE(hand.step(above(0.02)));

    const auto at = [](double x_m) { return HandPose{{x_m, 0.0, 0.05}}; };
    const auto refused = [](const Result<double, Refusal>& edited, const std::string& text)
    {
        const std::string line = line_of(edited);
        EXPECT_NE(line.find(text), std::string::npos) << line;
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    };
    refused(carve_hole(stiff), "carve(): 'stiff' has no room for edits; set edit_faces");
    refused(part.carve(sphere(0.01), at(0.0), at(0.0).position_m), "only 16 of the room for 16");
    refused(part.carve(point(), at(0.0), at(0.0).position_m), "carve(): tool: only a sphere");
    refused(part.carve(tool("mesh:part,0.01"), at(0.0), at(0.0).position_m), "only a sphere");
    refused(part.carve(tool("ball:1"), at(0.0), at(0.0).position_m), "tool: 'ball:1'");
    refused(part.carve(box(0.01, 0.01, 0.01, 0.001), at(0.0), {}), "only a sphere");
    refused(part.carve(hull({}), at(0.0), {}), "a hull needs corners");
    refused(part.carve(cutter(), at(kNan), {}), "carve(): position_m: ");
    refused(part.carve(cutter(), {{}, {0.0, 0.0, 0.0, 2.0}}, {}), "carve(): rotation: ");
    refused(part.carve(cutter(), at(0.0), {kNan, 0.0, 0.0}), "a number is not finite");
    refused(part.carve(cutter(), at(0.0), {1e9, 0.0, 0.0}), "farther than ");
    refused(part.fill(cutter(), above(0.0), above(0.0).position_m),
            "leave the model's box along z");
    refused(part.displace({0.0, 0.0, 0.0}, -1.0, {0.0, 0.0, 0.0}), "displace(): displacement: ");
    EXPECT_EQ(line_of(stiff.save("stiff.spm")),
              "save(): 'stiff' has no room for edits; set edit_faces");
    EXPECT_NEAR(press(hand, kRadius_m - kPress_m).proxy_m[2], kTop_m + kRadius_m, kNear_m);

    const WorldObject late = world->add(part, {.edit_faces = 17});
    EXPECT_EQ(late.error(), "edit_faces: 17; 0 to 16 is allowed, the room at the first frame");
    refused(carve_hole(late), "edit_faces: 17");
    ASSERT_TRUE(stiff.remove());
    refused(carve_hole(stiff), "carve(): the object was removed");
    world.reset();
    refused(carve_hole(part), "the World of this handle is gone");
}

TEST(WorldEdits, wrong_rooms_and_tools_are_refused_before_the_first_frame)
{
    World large;
    EXPECT_EQ(large.add(cube(), {.edit_faces = 300'000}).error(),
              "edit_faces: 300000; 0 to 262144 is allowed");
    EXPECT_EQ(World().add(published("bone"), {.edit_faces = 1}).error(),
              "edit_faces: 1; 0 to 0 is allowed for a published model");
    const auto tool_fault = [](const WorldTool& tool, const std::string& edit)
    { return World().add(tool, by_program(), {.edit = edit}).error(); };
    EXPECT_NE(tool_fault(point(), "carve:50").find("edit: the tool 'point' can't carve"),
              std::string::npos);
    EXPECT_NE(tool_fault(sphere(0.01), "carve:0").find("edit: 'carve:0'"), std::string::npos);
    World roomless;
    static_cast<void>(roomless.add(cube()));
    const Hand hand = roomless.add(sphere(kRadius_m), by_program(), {.edit = "carve:50"});
    EXPECT_EQ(line_of(hand.step(above(0.02))),
              "edit: no model can be edited; set edit_faces of an object");
    World full;
    static_cast<void>(full.add(cube(), {.edit_faces = 262'144}));
    const Hand none = full.add(sphere(kRadius_m));
    EXPECT_NE(line_of(none.step(above(0.02))).find("memory_mib: 2 MiB is too small"),
              std::string::npos);
}

TEST(WorldEdits, edits_that_no_frame_takes_are_refused_in_the_end)
{
    World world;
    const WorldObject part = world.add(cube(), {.edit_faces = kRoom});
    const Hand hand = world.add(sphere(kRadius_m));
    ASSERT_TRUE(hand.step(above(0.02)));
    std::string line;
    for (int i = 0; i < 2'000 && line.empty(); ++i)
    {
        // A corner of the cube, to and fro.
        const double corner_m = i % 2 == 0 ? 0.05 : 0.048;
        const double way_m = i % 2 == 0 ? -0.002 : 0.0019;
        line = line_of(part.displace({corner_m, corner_m, corner_m}, 0.01, {way_m, way_m, way_m}));
    }
    EXPECT_NE(line.find("edits wait for frames; at most 1024 are allowed"), std::string::npos)
        << line;
    for (int i = 0; i < 600; ++i)
    {
        ASSERT_TRUE(hand.step(above(0.02)));
    }
    EXPECT_TRUE(carve_hole(part));
}

} // namespace
} // namespace tactus::test
