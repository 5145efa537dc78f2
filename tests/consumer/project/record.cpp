// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
//
// record FILE RECORDING: a ball goes down into a model, a frame a millisecond; each frame is
// recorded, the recording is stored, read again and replayed. docs/how-to.md shows parts of it.
#include <array>
#include <cstdio>
#include <fstream>
#include <memory>
#include <optional>
#include <tactus/platform/recording/frame_tap.hpp>
#include <tactus/platform/recording/recording.hpp>
#include <tactus/platform/recording/recording_writer.hpp>
#include <tactus/platform/recording/replay.hpp>
#include <tactus/rt_core/frame/frame.hpp>
#include <tactus/transport/courier.hpp>
#include <tactus/transport/store/store_link.hpp>
#include <vector>

using namespace tactus;

namespace
{

constexpr std::uint64_t kFrames = 500;

int fail(const char* text)
{
    std::fprintf(stderr, "record: %s\n", text);
    return 2;
}

/// Puts the pieces of the model into the recording; called before a frame can have them.
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

int replay_file(const char* path)
{
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
    if (argc != 3)
    {
        std::fprintf(stderr, "usage: record FILE RECORDING\n");
        return 3;
    }
    const auto served = serve_from_file(argv[1], "ring", {});
    if (!served)
    {
        return fail(served.error().text.c_str());
    }
    const ServedModel& model = served.value();
    const ModelHeader header = ModelHeader::parse(model.header).value();

    ToolSpec ball;
    ball.radius_m = 0.002;
    const std::array<ObjectSpec, 1> objects{ObjectSpec{ModelId{0}}};
    constexpr std::size_t kBytes = std::size_t{4} << 20U;
    const auto memory = std::make_unique<std::byte[]>(kBytes + Arena::kAlignment);
    void* first = memory.get();
    std::size_t room = kBytes + Arena::kAlignment;
    std::align(Arena::kAlignment, kBytes, first, room);
    Arena arena({static_cast<std::byte*>(first), kBytes});
    const std::array<ModelSource, 1> sources{
        ModelSource{model.header, model.base, plan_capacities(header, kBytes / 2, 0)}};
    FrameSetup setup;
    setup.tools = {&ball, 1};
    setup.objects = objects;
    setup.models = sources;
    std::optional<Frame> frame;
    if (const auto started = Frame::start(frame, arena, setup); !started)
    {
        return fail(refusal_text(started.error()));
    }
    Model& parts = frame->model({0});
    Courier courier(arena, frame->pools().slots, frame->pools().cache.door, {});
    courier.add(parts.header, parts.linker, *model.link, model.name);

    FrameTap tap;
    RecordingWriter writer(to_recorded(setup));
    PieceCopies copies(writer);
    courier.copy_pieces_to(&copies);
    std::vector<std::byte> coded;
    bool touched = false;
    for (std::uint64_t i = 0; i < kFrames; ++i)
    {
        ToolState state;
        state.position_m = {0.028, 0.0, 0.02 - 2e-5 * static_cast<double>(i)};
        courier.step(static_cast<std::int64_t>(i) * setup.period_ns);
        const FrameInput input{.tools = {&state, 1}, .changes = {}, .budgets = {}, .now_ns = 0};
        const FrameOutput output = frame->run(input);
        tap.record(input, output); // The haptic thread's part.
        while (tap.try_take(coded))
        {
            writer.add_frame(coded); // Another thread's, or the same one's as here.
        }
        touched = touched || output.tools[0].in_contact;
    }
    writer.finish(tap.lost_from());
    const std::vector<std::byte> bytes = writer.take_bytes();
    std::ofstream(argv[2], std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    return touched ? replay_file(argv[2]) : fail("the ball never touched the model");
}
