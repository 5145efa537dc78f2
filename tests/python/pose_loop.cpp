// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
//
// pose_loop MODEL POSES RADIUS OUT: equivalent of tactus.Frame.run() as a loop in C++. POSES are
// doubles, x y z of each; OUT gets a force, lower and upper bound for each. The model is loaded
// completely first. Prints the CPU time of the loop in seconds.
#include "rt_core/frame/frame.hpp"
#include "transport/chunk_loader.hpp"
#include "transport/store/store_link.hpp"

#include <array>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <memory>
#include <new>
#include <optional>
#include <vector>

using namespace tactus;

namespace
{

constexpr std::size_t kBytes = std::size_t{32} << 20U;

struct alignas(Arena::kAlignment) Memory
{
    std::array<std::byte, kBytes> bytes;
};

std::vector<double> read_doubles(const char* path)
{
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    std::vector<double> values(static_cast<std::size_t>(file.tellg()) / sizeof(double));
    file.seekg(0);
    file.read(reinterpret_cast<char*>(values.data()),
              static_cast<std::streamsize>(values.size() * sizeof(double)));
    return values;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 5)
    {
        std::fprintf(stderr, "usage: pose_loop MODEL POSES RADIUS OUT\n");
        return 3;
    }
    const auto served = serve_from_file(argv[1], "model", {});
    if (!served)
    {
        std::fprintf(stderr, "pose_loop: %s\n", served.error().text.c_str());
        return 2;
    }
    const ServedModel& model = served.value();
    const ModelHeader header = ModelHeader::parse(model.header).value();
    const std::vector<double> poses = read_doubles(argv[2]);

    ToolSpec tool;
    tool.radius_m = std::strtod(argv[3], nullptr);
    const std::array<ObjectSpec, 1> objects{ObjectSpec{ModelId{0}}};
    const std::array<ModelSource, 1> sources{
        ModelSource{model.header, model.base, plan_capacities(header, kBytes / 2, 0)}};
    FrameSetup setup;
    setup.tools = {&tool, 1};
    setup.objects = objects;
    setup.models = sources;
    setup.static_when_it_fits = true;
    const auto memory = std::make_unique<Memory>();
    Arena arena(memory->bytes);
    std::optional<Frame> frame;
    if (const auto started = Frame::start(frame, arena, setup); !started)
    {
        std::fprintf(stderr, "pose_loop: %s\n", refusal_text(started.error()));
        return 2;
    }
    Model& parts = frame->model({0});
    ChunkLoader chunk_loader(arena, frame->pools().slots, frame->pools().cache.queues, {});
    chunk_loader.add(parts.header, parts.linker, *model.link, model.name);
    ToolState state;
    state.position_m = {poses[0], poses[1], poses[2]};
    FrameOutput output;
    do
    {
        chunk_loader.step(0);
        output = frame->run({.tools = {&state, 1}, .changes = {}, .budgets = {}, .now_ns = 0});
    } while (!output.models[0].is_static);

    std::vector<double> answers;
    answers.reserve(poses.size() / 3 * 5);
    const std::clock_t begin = std::clock();
    for (std::size_t i = 0; i + 2 < poses.size(); i += 3)
    {
        state.position_m = {poses[i], poses[i + 1], poses[i + 2]};
        output = frame->run({.tools = {&state, 1}, .changes = {}, .budgets = {}, .now_ns = 0});
        const Vec3& force_n = output.tools[0].force_n;
        const PairOutput& pair = output.pairs[0];
        answers.insert(answers.end(),
                       {force_n.x(), force_n.y(), force_n.z(), pair.lower_m, pair.upper_m});
    }
    std::printf("%.6f\n", static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    std::ofstream out(argv[4], std::ios::binary);
    out.write(reinterpret_cast<const char*>(answers.data()),
              static_cast<std::streamsize>(answers.size() * sizeof(double)));
    return out ? 0 : 2;
}
