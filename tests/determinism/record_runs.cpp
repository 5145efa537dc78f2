// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// record_runs FOLDER: touches generated shapes in several ways and writes a recording of each run
/// into the folder. Other builds must replay them bit for bit.

#include "host_tools/shapes/shapes.hpp"
#include "tests/shared/frame_rig.hpp"
#include "tests/shared/solid_cores.hpp"
#include "tests/stability/random_motion.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <fstream>
#include <numbers>

namespace tactus::test
{
namespace
{

constexpr std::uint32_t kFrames = 500;
/// Frames of a mesh tool, each of which costs hundreds of others if it is half inside an object.
constexpr std::uint32_t kMeshFrames = 20;

/// Descends onto the model's highest corner, and slightly into it.
Vec3 land(const TestModel& model, std::uint32_t frame)
{
    const auto top =
        std::ranges::max_element(model.faces, {}, [](const Face& face) { return face[0][2]; });
    const double height = std::max(0.004 - 0.001 * frame, -0.004);
    return to_vec3(top->at(0)) + Vec3(0.0, 0.0, height * model.diagonal_m);
}

/// Rotation of an extended tool there.
Mat3 turn(std::uint32_t frame)
{
    const Vec3 axis = Vec3(0.3, 0.5, 0.8).normalized();
    return Eigen::AngleAxisd(0.002 * frame, axis).toRotationMatrix();
}

/// Peg above its socket: moves into the hole, against the bottom, across it, and out.
Vec3 go_in(const TestModel& socket, std::uint32_t frame)
{
    constexpr double kInDepth_m = 0.041;
    constexpr double kAside_m = 0.002;
    const double in = std::min(frame / 200.0, 1.0) - std::max((frame - 350.0) / 150.0, 0.0);
    const double angle = 2.0 * std::numbers::pi * frame / 120.0;
    const bool is_in = frame > 220 && frame < 340;
    const Vec3 aside_m =
        is_in ? Vec3(kAside_m * std::sin(angle), kAside_m * std::sin(2.0 * angle), 0.0)
              : Vec3(0.0, 0.0, 0.0);
    const Vec3 origin_m(socket.origin_m[0], socket.origin_m[1], socket.origin_m[2]);
    return Vec3(0.0, 0.0, 0.051 - kInDepth_m * in) + aside_m - origin_m;
}

/// Rotation about the peg's axis in the hole, with tilts.
Mat3 screw(std::uint32_t frame)
{
    const Vec3 axis(0.03 * std::sin(0.05 * frame), 0.03 * std::sin(0.03 * frame), 1.0);
    return Eigen::AngleAxisd(0.003 * frame, axis.normalized()).toRotationMatrix();
}

struct Run
{
    const char* name;
    std::vector<const TestModel*> models;
    Vec3 (*motion)(const TestModel&,
                   std::uint32_t){nullptr}; ///< Motion; null: each tool has a WanderingOperator.
    RigOptions options;
    Budgets budgets;
    std::uint32_t frames{kFrames};
    /// Called before each frame.
    void (*change_scene)(FrameRig& rig, std::uint32_t frame){nullptr};
    std::uint32_t refused{0}; ///< Total of refused changes.
    Mat3 (*turning)(std::uint32_t){turn};
};

/// Tool with this core and all requests.
RigOptions with_core(RigOptions options, const ToolCore& core)
{
    options.tools = {{1e-4, 500.0, 8.0, 1.0, core, true}};
    // Query-only, so that faces meet.
    options.tools[0].query_only = std::holds_alternative<MeshCore>(core);
    return options;
}

/// Sphere, capsule with a proxy, and query-only box, at two objects of two models.
RigOptions crowd(RigOptions options)
{
    const Vec3 half(0.004, 0.002, 0.003);
    options.tools = {{0.003}, {0.001}, {1e-4}};
    options.tools[1].core = Segment{-half, half};
    options.tools[2].core = Box{half};
    options.tools[2].query_only = true;
    options.objects = {{ModelId{0}, {300.0, 0.4, 0.3, 0.5}}, {ModelId{1}}};
    return options;
}

/// Capacity for more objects than at the start.
RigOptions with_room(RigOptions options)
{
    options.capacities.objects = 4;
    return options;
}

/// Mesh tool with a proxy.
RigOptions held_mesh(RigOptions options, const MeshCore& core)
{
    options = with_core(options, core);
    options.tools[0].query_only = false;
    return options;
}

/// Mesh in a fitting mesh, with friction.
Run peg_in_hole(RigOptions options)
{
    const TestModel& socket = test_model("socket", make_shape(Shape::socket, 1'200).value());
    const TestModel& peg = test_model("peg", make_shape(Shape::peg, 300).value());
    options.tools = {{5e-5, 500.0, 8.0, 1.0, MeshCore{ModelId{1}}}};
    options.objects = {{ModelId{0}, {500.0, 0.3, 0.2, 0.5}}};
    return {"peg", {&socket, &peg}, go_in, options, {}, kFrames, nullptr, 0, screw};
}

/// Pose of an object that swings and rotates.
ObjectPose pose_at(std::uint32_t frame, std::size_t object, std::int64_t now_ns)
{
    const double angle = 0.001 * frame * (object == 0 ? 1.0 : -1.0);
    ObjectPose pose;
    pose.rotation = Eigen::AngleAxisd(angle, Vec3(0.6, 0.0, 0.8)).toRotationMatrix();
    pose.translation_m = 0.01 * std::sin(angle) * Vec3(1.0, 2.0, -1.0);
    pose.scale = object == 0 ? 1.0 : 0.7;
    pose.arrival_ns = now_ns - (frame % 100 == 99 ? 200'000'000 : 1'000'000);
    return pose;
}

void move_objects(FrameRig& rig, std::uint32_t frame)
{
    for (std::size_t object = 0; object < 2; ++object)
    {
        rig.place_object(pose_at(frame, object, rig.now_ns()), object);
    }
}

SceneChange change_of(SceneChangeKind kind, std::uint32_t number, std::uint32_t generation = 0)
{
    SceneChange change;
    change.kind = kind;
    change.number = number;
    change.generation = generation;
    change.object = {ModelId{number % 2}, {350.0, 0.4, 0.3, 0.2, 0.5, 2e-5, 1e-3}};
    return change;
}

/// All kinds of changes, also of touched objects, with some that must be refused.
void come_and_go(FrameRig& rig, std::uint32_t frame)
{
    using Kind = SceneChangeKind;
    const auto at = [&rig, frame](std::uint32_t when, SceneChange change)
    {
        if (frame == when)
        {
            change.pose.translation_m = Vec3(0.02, 0.0, 0.0) * change.number;
            rig.change(change);
        }
    };
    at(0, change_of(Kind::object_moves, 1));
    at(60, change_of(Kind::object_feels, 0));
    at(90, change_of(Kind::object_feels, 0, 1)); // Wrong generation.
    at(120, change_of(Kind::object_goes, 1));
    at(150, change_of(Kind::tool_goes, 2));
    at(180, change_of(Kind::object_comes, 3, 1));
    at(200, change_of(Kind::object_moves, 1)); // Absent.
    at(240, change_of(Kind::tool_comes, 2));
    at(240, change_of(Kind::tool_comes, 2)); // Already present.
    at(260, change_of(Kind::object_comes, 1, 1));
    at(300, change_of(Kind::object_goes, 0));
    at(330, change_of(Kind::object_comes, 0, 1));
    at(331, change_of(Kind::object_moves, 0)); // Previous generation.
    at(350, change_of(Kind::object_comes, 4)); // Number out of range.
    at(400, change_of(Kind::tool_goes, 0));
    at(420, change_of(Kind::tool_comes, 0));
}
constexpr std::uint32_t kRefusedOfThose = 5;

std::vector<Run> runs()
{
    const MeshCore mesh{ModelId{1}, Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.0)};
    const std::vector<const TestModel*> models = small_models();
    RigOptions usual;
    usual.record = true;
    usual.faults.delay_polls_max = 20;
    RigOptions starved = usual;
    starved.pool_bytes = std::size_t{400} << 10U;
    starved.faults.loss = 0.1;
    starved.faults.duplicates = 0.1;
    starved.faults.delay_polls_max = 40;
    RigOptions fixed = usual;
    fixed.static_when_it_fits = true;
    Budgets few;
    few.splits = 6;
    few.merges = 4;
    few.nodes = 64;
    few.triangles = 200;
    few.pages = 1;
    few.requests = 2;
    const RigOptions spike = with_core(usual, spike_core(0.0).core);
    return {{"smooth", {models[0]}, nullptr, usual, {}},
            {"sharp", {models[3]}, nullptr, usual, {}},
            {"open", {models[2]}, nullptr, usual, {}},
            {"starvation", {models[0]}, nullptr, starved, few},
            {"needles", {models[5]}, nullptr, usual, {}},
            {"static", {models[1]}, nullptr, fixed, {}},
            {"box", {models[3]}, nullptr, with_core(usual, Box{Vec3(0.004, 0.002, 0.003)}), {}},
            {"hull", {models[0]}, nullptr, spike, {}},
            {"mesh", {models[0], models[1]}, land, with_core(usual, mesh), {}, kMeshFrames},
            {"held_mesh", {models[0], models[1]}, land, held_mesh(usual, mesh), {}, kMeshFrames},
            {"crowd", {models[0], models[1]}, nullptr, crowd(usual), {}, kFrames, move_objects},
            {"comings",
             {models[0], models[1]},
             nullptr,
             with_room(crowd(usual)),
             {},
             kFrames,
             come_and_go,
             kRefusedOfThose},
            peg_in_hole(usual)};
}

/// Records a run. False if the file cannot be written, or the number of refused changes is wrong.
bool record(const Run& run, const std::filesystem::path& folder)
{
    FrameRig rig(run.models, run.options);
    std::vector<ToolState> tools(std::max<std::size_t>(run.options.tools.size(), 1));
    std::deque<Random> randoms; // The hands keep their addresses.
    std::deque<WanderingOperator> hands;
    for (std::uint32_t i = 0; i < tools.size(); ++i)
    {
        randoms.push_back(Random::seeded(20'261'127 + i));
        hands.emplace_back(*run.models[0], randoms.back());
    }
    std::uint64_t faces = 0;
    std::uint32_t contacts = 0;
    std::uint32_t static_frames = 0;
    std::uint32_t refused = 0;
    for (std::uint32_t frame = 0; frame < run.frames; ++frame)
    {
        for (std::uint32_t i = 0; i < tools.size(); ++i)
        {
            tools[i].position_m =
                run.motion != nullptr ? run.motion(*run.models[0], frame) : hands[i].next();
            tools[i].rotation = run.turning(frame);
        }
        if (run.change_scene != nullptr)
        {
            run.change_scene(rig, frame);
        }
        const FrameOutput output = rig.step(tools, run.budgets);
        faces += output.work.splits;
        contacts += output.tools[0].in_contact ? 1U : 0U;
        static_frames += output.models[0].is_static ? 1U : 0U;
        for (const std::uint32_t count : output.scene.refused)
        {
            refused += count;
        }
    }
    const std::vector<std::byte> bytes = rig.finish_recording();
    std::ofstream file(folder / (std::string(run.name) + ".rec"), std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    std::printf("%s: %u frames, %u in contact, %u static, %llu splits, %u changes refused, "
                "%zu bytes\n",
                run.name, run.frames, contacts, static_frames,
                static_cast<unsigned long long>(faces), refused, bytes.size());
    return static_cast<bool>(file.flush()) && refused == run.refused;
}

} // namespace
} // namespace tactus::test

int main(int argc, char** argv)
{
    if (argc != 2)
    {
        std::printf("usage: record_runs FOLDER\n");
        return 3;
    }
    std::filesystem::create_directories(argv[1]);
    bool is_written = true;
    for (const tactus::test::Run& run : tactus::test::runs())
    {
        is_written = tactus::test::record(run, argv[1]) && is_written;
    }
    return is_written ? 0 : 2;
}
