// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
//
// scene FILE: a thousand objects that show one model, two tools of one's own shape that go down
// among them, an object that moves, and one that comes and goes. docs/how-to.md shows parts of it.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <tactus/rt_core/force/safe_state.hpp>
#include <tactus/rt_core/frame/frame.hpp>
#include <tactus/rt_core/geometry/convex.hpp>
#include <tactus/transport/courier.hpp>
#include <tactus/transport/store/store_link.hpp>
#include <vector>

using namespace tactus;

namespace
{

constexpr std::uint32_t kSide = 10;
constexpr std::uint32_t kObjects = kSide * kSide * kSide;
constexpr std::uint32_t kFrames = 2'000;

int fail(const char* text)
{
    std::fprintf(stderr, "scene: %s\n", text);
    return 2;
}

/// A grid of objects, `step_m` apart, the last layer at a height of 0.
std::vector<ObjectPose> grid(double step_m)
{
    std::vector<ObjectPose> poses(kObjects);
    for (std::uint32_t i = 0; i < kObjects; ++i)
    {
        const Vec3 place(i % kSide, i / kSide % kSide, 1.0 + i / (kSide * kSide) - kSide);
        poses[i].translation_m = step_m * place;
    }
    return poses;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 2)
    {
        std::fprintf(stderr, "usage: scene FILE\n");
        return 3;
    }
    const auto served = serve_from_file(argv[1], "ring", {});
    if (!served)
    {
        return fail(served.error().text.c_str());
    }
    const ServedModel& model = served.value();
    const ModelHeader header = ModelHeader::parse(model.header).value();
    const double size_m = header.diagonal_m();

    // A brick with rounded edges.
    ToolSpec brick;
    brick.core = Box{{0.1 * size_m, 0.05 * size_m, 0.02 * size_m}};
    brick.radius_m = 0.01 * size_m;

    // A wedge: the convex hull of its corners, which stay where they are while the frame lives.
    const double wide_m = 0.04 * size_m;
    const std::array<Vec3, 6> corners{Vec3(-wide_m, -wide_m, wide_m), Vec3(wide_m, -wide_m, wide_m),
                                      Vec3(-wide_m, wide_m, wide_m),  Vec3(wide_m, wide_m, wide_m),
                                      Vec3(0.0, -wide_m, -wide_m),    Vec3(0.0, wide_m, -wide_m)};
    const auto hull = Hull::create(corners);
    if (!hull)
    {
        return fail("a corner of the wedge is not finite");
    }
    ToolSpec wedge;
    wedge.core = hull.value();
    wedge.radius_m = 0.005 * size_m;

    const std::array<ToolSpec, 2> tools{brick, wedge};

    // All objects show model 0; the material is each one's own.
    std::vector<ObjectSpec> objects(kObjects);
    for (ObjectSpec& object : objects)
    {
        object.model = ModelId{0};
        object.material.stiffness_n_per_m = 800.0;
    }
    const std::vector<ObjectPose> poses = grid(1.5 * size_m);

    FrameSetup setup;
    setup.tools = tools;
    setup.objects = objects;
    setup.poses = poses;
    setup.capacities.objects = kObjects + 1; // Room for one that comes later.

    constexpr std::size_t kBytes = std::size_t{16} << 20U;
    const auto memory = std::make_unique<std::byte[]>(kBytes + Arena::kAlignment);
    void* first = memory.get();
    std::size_t room = kBytes + Arena::kAlignment;
    std::align(Arena::kAlignment, kBytes, first, room);
    Arena arena({static_cast<std::byte*>(first), kBytes});
    const std::array<ModelSource, 1> sources{
        ModelSource{model.header, model.base, plan_capacities(header, kBytes / 2, 0)}};
    setup.models = sources;
    std::optional<Frame> frame;
    if (const auto started = Frame::start(frame, arena, setup); !started)
    {
        return fail(refusal_text(started.error()));
    }
    Model& parts = frame->model({0});
    Courier courier(arena, frame->pools().slots, frame->pools().cache.door, {});
    courier.add(parts.header, parts.linker, *model.link, model.name);

    // The highest vertex of the base mesh lies on the surface.
    const auto vertices = parts.slots.base.positions_m;
    const Vec3 top =
        header.origin_m() +
        to_vec3(*std::max_element(vertices.begin(), vertices.end(),
                                  [](const Vec3f& a, const Vec3f& b) { return a[2] < b[2]; }));

    std::array<SafeState, 2> safe{
        SafeState({1.0, brick.force_max_n, brick.stiffness_n_per_m, 0.0, brick.torque_max_nm}),
        SafeState({1.0, wedge.force_max_n, wedge.stiffness_n_per_m, 0.0, wedge.torque_max_nm})};
    std::uint32_t refused = 0;
    std::uint32_t felt = 0;
    std::uint32_t wrong = 0;
    std::uint32_t most_objects = 0;
    for (std::uint32_t i = 0; i < kFrames; ++i)
    {
        const double share = static_cast<double>(i) / kFrames;
        std::array<ToolState, 2> states;
        for (std::size_t tool = 0; tool < states.size(); ++tool)
        {
            // Each above an object of the upper layer, and down into it.
            const Vec3& place = poses[kObjects - 1 - 5 * tool].translation_m;
            states[tool].position_m = place + top + size_m * Vec3(0.0, 0.0, 0.2 - 0.25 * share);
        }

        std::vector<SceneChange> changes;
        // Object 0 goes round in a circle.
        SceneChange moves;
        moves.kind = SceneChangeKind::object_moves;
        moves.number = 0;
        moves.pose.translation_m =
            poses[0].translation_m +
            0.1 * size_m * Vec3(std::cos(6.28 * share), std::sin(6.28 * share), 0.0);
        changes.push_back(moves);

        // Object 1,000 is there from frame 500 to frame 1,500, twice as large as the others.
        // Another one of this number would be of generation 1.
        SceneChange guest;
        guest.number = kObjects;
        guest.generation = 0;
        if (i == 500)
        {
            guest.kind = SceneChangeKind::object_comes;
            guest.object.model = ModelId{0};
            guest.pose.translation_m = Vec3(0.0, 0.0, 10.0 * size_m);
            guest.pose.scale = 2.0;
            changes.push_back(guest);
        }
        else if (i == 1'500)
        {
            guest.kind = SceneChangeKind::object_goes;
            changes.push_back(guest);
        }

        courier.step(std::int64_t{i} * setup.period_ns);
        const FrameOutput output =
            frame->run({.tools = states, .changes = changes, .budgets = {}, .now_ns = 0});

        for (const std::uint32_t count : output.scene.refused)
        {
            refused += count; // Why: ChangeRefusal, in this order.
        }
        for (const PairOutput& pair : output.pairs)
        {
            // Only objects near a tool have a pair; to all others it is proven clear.
            wrong += pair.lower_m > pair.upper_m ? 1 : 0;
        }
        for (std::size_t tool = 0; tool < states.size(); ++tool)
        {
            SafetyInput input;
            input.position_m = states[tool].position_m;
            input.elapsed_s = 1e-9 * static_cast<double>(setup.period_ns);
            input.force_n = output.tools[tool].force_n;
            input.torque_nm = output.tools[tool].torque_nm;
            input.proxy_m = output.tools[tool].proxy_m;
            input.faults = faults_of(output.tools[tool]);
            felt += safe[tool].step(input).force_n.norm() > 0.0 ? 1 : 0;
        }
        most_objects = output.scene.objects > most_objects ? output.scene.objects : most_objects;
    }
    std::printf("%u objects at most, a force in %u answers of tools, %u changes refused\n",
                most_objects, felt, refused);
    return most_objects == kObjects + 1 && felt > 0 && refused == 0 && wrong == 0 ? 0 : 1;
}
