// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/force_pipeline.hpp"
#include "rt_core/frame/frame.hpp"
#include "transport/base/print_assertions.hpp"
#include "transport/chunk_loader.hpp"
#include "transport/store/store_link.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>

using namespace tactus;

// All memory of the frame, provided once. Too little is refused, nothing grows.
alignas(Arena::kAlignment) static std::array<std::byte, std::size_t{4} << 20U> memory;

int main(int argc, char** argv)
{
    print_failed_assertions(); // Assertions are printed before they end the program.

    // The model is from a local file; DdsClient::find() returns the same record of a published one.
    const auto served = serve_from_file(argc > 1 ? argv[1] : "torus.spm", "hello", {});
    if (!served)
    {
        std::fprintf(stderr, "hello: %s\n", served.error().text.c_str());
        return 2;
    }
    const ServedModel& model = served.value();
    const ModelHeader header = ModelHeader::parse(model.header).value();

    // One sphere of 1 % of the model's size, one object, half of the memory for the model's pools.
    const double radius_m = 0.01 * header.diagonal_m();
    const std::array<ToolSpec, 1> tools{ToolSpec{radius_m, 500.0, 8.0, 1.0}};
    const std::array<ObjectSpec, 1> objects{ObjectSpec{ModelId{0}}};
    const ModelCapacities capacities = plan_capacities(header, memory.size() / 2, 0);
    if (capacities.pages == 0)
    {
        std::fprintf(stderr, "hello: the model needs more memory\n");
        return 2;
    }
    const std::array<ModelSource, 1> sources{ModelSource{model.header, model.base, capacities}};
    FrameSetup setup;
    setup.tools = tools;
    setup.objects = objects;
    setup.models = sources;
    Arena arena(memory);
    std::optional<Frame> frame;
    if (const auto started = Frame::start(frame, arena, setup); !started)
    {
        std::fprintf(stderr, "hello: %s\n", refusal_text(started.error()));
        return 2;
    }

    // The transport thread does this in hrtc. Here both run in turn on one thread.
    Model& parts = frame->model({0});
    ChunkLoader chunk_loader(arena, frame->pools().slots, frame->pools().cache.queues, {});
    chunk_loader.add(parts.header, parts.linker, *model.link, model.name);

    // A model has the pose of its source mesh unless another one is given. Its base vertices are on
    // the surface. The tool descends to the highest one and 0.5 mm into it, in 0.5 s.
    const auto vertices = parts.slots.base.positions_m;
    const Vec3 top =
        header.origin_m() +
        to_vec3(*std::max_element(vertices.begin(), vertices.end(),
                                  [](const Vec3f& a, const Vec3f& b) { return a[2] < b[2]; }));
    std::array<ToolState, 1> states{};
    const double period_s = 1e-9 * static_cast<double>(setup.period_ns);
    // Limits of the device, and the fading of a force if the frame requires it.
    ForcePipeline pipeline(pipeline_setup(tools[0], DeviceLimits{}, period_s, 1.0));
    FrameOutput output;
    Vec3 to_device_n(0.0, 0.0, 0.0);
    for (int i = 0; i <= 500; ++i)
    {
        const double height_m = 3.0 * radius_m - (3.0 * radius_m + 0.0005) * i / 500.0;
        states[0].position_m = top + Vec3(0.0, 0.0, height_m);
        chunk_loader.step(i * setup.period_ns);
        output = frame->run({.tools = states, .changes = {}, .budgets = {}, .now_ns = 0});
        to_device_n =
            pipeline.step(states[0], output.tools[0], {}, {}, {.elapsed_s = period_s}).push.force_n;
    }

    const PairOutput& pair = output.pairs[0];
    std::printf("%s, distance %.3f to %.3f mm, force %.3f %.3f %.3f N\n",
                pair.kind == AnswerKind::exact ? "exact" : "not exact", pair.lower_m * 1e3,
                pair.upper_m * 1e3, to_device_n.x(), to_device_n.y(), to_device_n.z());
    return output.tools[0].in_contact ? 0 : 1;
}
