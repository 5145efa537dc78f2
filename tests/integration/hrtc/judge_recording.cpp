// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// judge_recording RECORDING MODEL [FRAME]...: repeats the frames of a recording of one sphere and
/// one object, compares each answer with the whole source mesh, and prints figures as JSON for
/// check_report: of the whole, and of each span between the given frames. Bounds that miss the true
/// distance are reported on stderr. Exits 2 if a file cannot be read or the replay differs from the
/// recording.

#include "host_tools/encode/extract.hpp"
#include "platform/recording/recording.hpp"
#include "platform/recording/replay.hpp"
#include "tests/stability/bracket_trial.hpp"
#include "tests/stability/tool_oracle.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>
#include <vector>

namespace
{

using namespace tactus;
using Json = nlohmann::ordered_json;

struct Span
{
    std::uint64_t end{0}; ///< First frame of the next span.
    std::uint64_t frames{0};
    std::uint64_t contact_frames{0};
    std::uint64_t violations{0}; ///< Frames whose true distance is not between L and U.
    double force_max_n{0.0};     ///< Force of the frame; the device may get less.
};

struct Refused
{
    std::string text;
};

/// All faces of the source on its grid, in the model frame, read independently.
test::TestModel source_of(const std::string& path)
{
    const auto store = ModelStore::open(path);
    if (!store)
    {
        throw Refused{store.error().text};
    }
    std::vector<std::string> damage;
    const DecodedModel model = DecodedModel::decode(store.value(), damage);
    if (!damage.empty())
    {
        throw Refused{damage.front()};
    }
    const TriangleMesh mesh = extract(model, {std::nullopt, 0.0, std::nullopt}).mesh;
    const auto& origin_m = model.header().fields().origin_m;
    test::TestModel source;
    source.origin_m = origin_m;
    for (const auto& corners : mesh.faces)
    {
        test::Face& face = source.faces.emplace_back();
        for (std::size_t i = 0; i < 3; ++i)
        {
            const auto& p = mesh.positions[corners[i]];
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                face[i][axis] = static_cast<float>(p[axis] - origin_m[axis]);
            }
        }
    }
    return source;
}

void judge(Span& span, const test::CenterOracle& oracle, const std::array<double, 3>& origin_m,
           const ObjectPose& placed, std::uint64_t frame, const FrameOutput& returned)
{
    const ToolOutput& tool = returned.tools[0];
    ++span.frames;
    span.contact_frames += tool.in_contact ? 1U : 0U;
    span.force_max_n = std::max(span.force_max_n, tool.force_n.norm());
    const auto verdict = test::judge_bracket(
        oracle, returned.pairs[0], model_pose(placed, Vec3(origin_m[0], origin_m[1], origin_m[2])));
    if (verdict.error > 1.0)
    {
        ++span.violations;
        std::fprintf(stderr, "frame %llu: %s\n", static_cast<unsigned long long>(frame),
                     verdict.text.c_str());
    }
}

Json json_of(const std::vector<Span>& spans)
{
    Json list = Json::array();
    std::uint64_t frames = 0;
    std::uint64_t violations = 0;
    for (const Span& span : spans)
    {
        frames += span.frames;
        violations += span.violations;
        list.push_back({{"frames", span.frames},
                        {"contact_frames", span.contact_frames},
                        {"violations", span.violations},
                        {"force_max_n", span.force_max_n}});
    }
    return {{"frames", frames}, {"violations", violations}, {"spans", list}};
}

int run(const std::string& recorded, const std::string& model, std::vector<Span> spans)
{
    const auto recording = Recording::read(recorded);
    if (!recording)
    {
        throw Refused{recording.error().text};
    }
    const FrameShape shape = recording.value().shape();
    const std::vector<ObjectPose>& placed = recording.value().setup().poses;
    if (shape.tools != 1 || placed.size() != 1)
    {
        throw Refused{recorded + ": is not of one tool and one object"};
    }
    const test::TestModel source = source_of(model);
    const test::CenterOracle oracle(source);
    std::size_t current = 0;
    const ReplayWatch watch{
        {},
        [&](std::uint64_t frame, const RecordedFrame& /*given*/, const FrameOutput& returned)
        {
            while (frame >= spans[current].end)
            {
                ++current;
            }
            judge(spans[current], oracle, source.origin_m, placed[0], frame, returned);
        }};
    const auto replayed = replay(recording.value(), nullptr, watch);
    if (!replayed || replayed.value().difference)
    {
        throw Refused{replayed ? replay_line(recording.value(), replayed.value())
                               : replayed.error().text};
    }
    std::puts(json_of(spans).dump(2).c_str());
    return 0;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc < 3)
    {
        std::fprintf(stderr, "usage: judge_recording RECORDING MODEL [FRAME]...\n");
        return 2;
    }
    try
    {
        std::vector<Span> spans;
        for (int i = 3; i < argc; ++i)
        {
            spans.push_back({.end = std::stoull(argv[i])});
        }
        spans.push_back({.end = kNoFrame});
        return run(argv[1], argv[2], std::move(spans));
    }
    catch (const Refused& refused)
    {
        std::fprintf(stderr, "%s\n", refused.text.c_str());
    }
    catch (const std::exception& error)
    {
        std::fprintf(stderr, "%s\n", error.what());
    }
    return 2;
}
