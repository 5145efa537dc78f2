// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
//
// touch FILE RECORDING, or touch NAME RECORDING DOMAIN: a pen, a brick and a wedge descend among a
// thousand objects that show one model, from a file or a server. Objects are moved, added and
// removed. Prints a digest over every bit of the answers and forces, which for a file is the same
// with every compiler. All frames are recorded and replayed. docs/library.md and docs/how-to.md
// show parts of it.
#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <optional>
#include <tactus/platform/recording/frame_tap.hpp>
#include <tactus/platform/recording/recording.hpp>
#include <tactus/platform/recording/recording_writer.hpp>
#include <tactus/platform/recording/replay.hpp>
#include <tactus/rt_core/force/external_force.hpp>
#include <tactus/rt_core/force/force_pipeline.hpp>
#include <tactus/rt_core/frame/frame.hpp>
#include <tactus/rt_core/geometry/convex.hpp>
#include <tactus/transport/chunk_loader.hpp>
#include <tactus/transport/dds/dds_client.hpp>
#include <tactus/transport/store/store_link.hpp>
#include <thread>
#include <vector>

using namespace tactus;

namespace
{

constexpr std::uint32_t kSide = 10;
constexpr std::uint32_t kObjects = kSide * kSide * kSide;
constexpr std::uint32_t kFrames = 2'000;

/// FNV-1a over the bits of doubles.
class Digest
{
public:
    void add(double value)
    {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        for (unsigned shift = 0; shift < 64; shift += 8)
        {
            hash_ = (hash_ ^ ((bits >> shift) & 0xFFU)) * 0x100'0000'01B3U;
        }
    }
    void add(const Vec3& value)
    {
        add(value.x());
        add(value.y());
        add(value.z());
    }
    [[nodiscard]] std::uint64_t value() const { return hash_; }

private:
    std::uint64_t hash_{0xCBF2'9CE4'8422'2325U};
};

/// Copies the pieces of the model into the recording before a frame can have them.
class PieceCopies final : public PieceSink
{
public:
    explicit PieceCopies(RecordingWriter& writer) : writer_(writer) {}
    void receive(ContentKey key, std::span<const std::byte> bytes) override
    {
        writer_.add_piece(0, key, bytes);
    }

private:
    RecordingWriter& writer_;
};

int fail(const char* text)
{
    std::fprintf(stderr, "touch: %s\n", text);
    return 2;
}

/// Grid of objects, `step_m` apart, the last layer at height 0.
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

/// Stores a recording and replays it.
int replay_file(const char* path, const std::vector<std::byte>& bytes)
{
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    const auto recording = Recording::read(path);
    if (!recording)
    {
        return fail(recording.error().text.c_str());
    }
    const auto report = replay(recording.value());
    if (!report)
    {
        return fail(report.error().text.c_str());
    }
    std::printf("%s\n", replay_line(recording.value(), report.value()).c_str());
    return report.value().difference || report.value().frames != kFrames ? 1 : 0;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc < 3 || argc > 4)
    {
        std::fprintf(stderr, "usage: touch FILE RECORDING | touch NAME RECORDING DOMAIN\n");
        return 3;
    }
    std::unique_ptr<dds::DdsClient> client; // Client; must outlive the model's link.
    Result<ServedModel, Refusal> served = Refusal{};
    if (argc == 3)
    {
        served = serve_from_file(argv[1], "ring", {});
    }
    else
    {
        const auto domain = static_cast<std::uint32_t>(std::strtoul(argv[3], nullptr, 10));
        auto joined = dds::DdsClient::create(domain, "touch", {});
        if (!joined)
        {
            return fail(joined.error().text.c_str());
        }
        client = std::move(joined).value();
        served = client->find({argv[1], {}}, std::chrono::seconds(60));
    }
    if (!served)
    {
        return fail(served.error().text.c_str());
    }
    const ServedModel& model = served.value();
    const ModelHeader header = ModelHeader::parse(model.header).value();
    const double size_m = header.diagonal_m();

    // The pen is 30 mm long, 2 mm thick and upright.
    ToolSpec pen;
    pen.core = Segment{{0.0, 0.0, 0.0}, {0.0, 0.0, 0.03}};
    pen.radius_m = 0.001;
    pen.wants_contacts = true;

    // The brick has rounded edges.
    ToolSpec brick;
    brick.core = Box{{0.1 * size_m, 0.05 * size_m, 0.02 * size_m}};
    brick.radius_m = 0.01 * size_m;

    // The wedge is the convex hull of its corners, which must stay in place for the frame's
    // lifetime.
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

    const std::array<ToolSpec, 3> tools{pen, brick, wedge};

    // All objects show model 0; each has its own material.
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
    setup.capacities.objects = kObjects + 1; // One more for an object that is added later.

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
    ChunkLoader chunk_loader(arena, frame->pools().slots, frame->pools().cache.queues, {});
    chunk_loader.add(parts.header, parts.linker, *model.link, model.name);
    FrameTap tap;
    RecordingWriter writer(to_recorded(setup));
    PieceCopies copies(writer);
    chunk_loader.copy_pieces_to(&copies);
    std::vector<std::byte> coded;

    // The highest vertex of the base mesh lies on the surface.
    const auto vertices = parts.slots.base.positions_m;
    const Vec3 top =
        header.origin_m() +
        to_vec3(*std::max_element(vertices.begin(), vertices.end(),
                                  [](const Vec3f& a, const Vec3f& b) { return a[2] < b[2]; }));
    // Each tool descends into an object of the upper layer, the pen into the last one.
    const auto above = [&](std::size_t tool)
    { return Vec3(poses[kObjects - 1 - 5 * tool].translation_m + top); };

    const double period_s = 1e-9 * static_cast<double>(setup.period_ns);
    const Vec3 middle_m = above(0);
    const DeviceLimits limits; // Limits of a device at least as strong as most, without torque.
    std::vector<ForcePipeline> pipelines;
    for (const ToolSpec& tool : tools)
    {
        pipelines.emplace_back(pipeline_setup(tool, limits, period_s, 1.0));
    }
    Vec3 pushed_n(0.0, 0.0, 0.0);
    Digest digest;
    std::array<std::uint32_t, 3> felt{};
    std::uint32_t touched = 0;
    std::uint32_t contacts = 0;
    std::uint32_t exact = 0;
    std::uint32_t wrong = 0;
    std::uint32_t refused = 0;
    std::uint32_t most_objects = 0;
    for (std::uint32_t i = 0; i < kFrames; ++i)
    {
        const double share = static_cast<double>(i) / kFrames;
        std::array<ToolState, 3> states;
        // The hand that holds the pen yields 0.2 mm a newton.
        states[0].position_m = above(0) + Vec3(0.0, 0.0, 0.017 - 0.06 * share) + 2e-4 * pushed_n;
        for (std::size_t tool = 1; tool < states.size(); ++tool)
        {
            states[tool].position_m = above(tool) + size_m * Vec3(0.0, 0.0, 0.2 - 0.25 * share);
        }

        std::vector<SceneChange> changes;
        // Object 0 moves in a circle.
        SceneChange moves;
        moves.kind = SceneChangeKind::object_moves;
        moves.number = 0;
        moves.pose.translation_m =
            poses[0].translation_m +
            0.1 * size_m * Vec3(std::cos(6.28 * share), std::sin(6.28 * share), 0.0);
        changes.push_back(moves);

        // The object under the pen rotates.
        moves.number = kObjects - 1;
        moves.pose = poses.back();
        moves.pose.rotation =
            Eigen::AngleAxisd(0.6 * share, Eigen::Vector3d::UnitZ()).toRotationMatrix();
        changes.push_back(moves);

        // Object 1,000 exists from frame 500 to frame 1,500, twice as large as the others. Another
        // one of this number would be of generation 1.
        SceneChange streamed_model;
        streamed_model.number = kObjects;
        streamed_model.generation = 0;
        if (i == 500)
        {
            streamed_model.kind = SceneChangeKind::object_comes;
            streamed_model.object.model = ModelId{0};
            streamed_model.pose.translation_m = Vec3(0.0, 0.0, 10.0 * size_m);
            streamed_model.pose.scale = 2.0;
            changes.push_back(streamed_model);
        }
        else if (i == 1'500)
        {
            streamed_model.kind = SceneChangeKind::object_goes;
            changes.push_back(streamed_model);
        }

        chunk_loader.step(std::int64_t{i} * setup.period_ns);
        const FrameInput input{.tools = states, .changes = changes, .budgets = {}, .now_ns = 0};
        const FrameOutput output = frame->run(input);
        tap.record(input, output); // Called on the haptic thread.
        while (tap.try_take(coded))
        {
            writer.add_frame(coded); // Called on any thread.
        }

        for (std::size_t tool = 0; tool < states.size(); ++tool)
        {
            const ToolState& state = states[tool];
            const ToolOutput& of_frame = output.tools[tool];
            // A spring of 50 N/m guides the pen towards a point, with at most 1 N.
            const ExternalForce guide = spring_to(middle_m, state.position_m, 50.0, 1.0);
            const ExternalForce own = tool == 0 ? guide : ExternalForce{};
            const ToolForce& force =
                pipelines[tool].step(state, of_frame, {}, own, {.elapsed_s = period_s});
            const Vec3 sent_n = force.push.force_n;
            if (tool == 0)
            {
                pushed_n = sent_n;
                touched += of_frame.in_contact ? 1 : 0;
            }
            digest.add(sent_n);
            digest.add(of_frame.proxy_m);
            felt[tool] += sent_n.norm() > 0.0 ? 1 : 0;
        }
        for (const PairOutput& pair : output.pairs)
        {
            // Only objects near a tool have a pair; all others are proven clear.
            wrong += pair.lower_m > pair.upper_m ? 1 : 0;
        }
        for (const PairOutput& pair : output.pairs)
        {
            digest.add(pair.lower_m);
            digest.add(pair.upper_m);
            digest.add(pair.nearest_point_m);
            exact += pair.kind == AnswerKind::exact ? 1 : 0;
            contacts += pair.contacts != nullptr && pair.contacts->contacts.size() > 0 ? 1 : 0;
        }
        for (const std::uint32_t count : output.scene.refused)
        {
            refused += count; // Counts by ChangeRefusal.
        }
        most_objects = std::max(most_objects, output.scene.objects);
        if (client)
        {
            std::this_thread::sleep_for(std::chrono::nanoseconds(setup.period_ns));
        }
    }
    std::printf("touched in %u frames, %u exact answers, %u reports of contacts, %u objects at "
                "most, digest %016llx\n",
                touched, exact, contacts, most_objects,
                static_cast<unsigned long long>(digest.value()));
    const bool is_felt = touched > 0 && felt[1] > 0 && felt[2] > 0 && exact > 0 && contacts > 0;
    if (!is_felt || wrong > 0 || refused > 0 || most_objects != kObjects + 1)
    {
        return fail("that is not what it should be");
    }
    writer.finish(tap.lost_from());
    return replay_file(argv[2], writer.take_bytes());
}
