// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/recording/frame_decoder.hpp"
#include "platform/recording/frame_encoder.hpp"
#include "platform/recording/recording_writer.hpp"
#include "tests/unit/transport/tiny_model.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace tactus::test
{

/// Arguments and output of a frame of one tool, one model and two changes, with all values
/// different.
struct ExampleFrame
{
    std::array<ToolState, 1> tools{ToolState{Vec3(0.5, -0.25, 2.0), 77, 3, true}};
    std::array<DeviceRecord, 1> devices{};
    std::array<SceneChange, 3> changes{};
    std::vector<SurfaceEdit> edits{}; ///< None at first.
    Budgets budgets{11, 12, 13, 14, 15, 16, 17, 18, 19, 20};
    std::array<QueueEvent, 2> events{
        QueueEvent{{ContentKind::chunk, 1}, 2, 5, 0xF0F0, QueueEventKind::arrival},
        QueueEvent{{ContentKind::chunk, 1}, 2, 6, 0xFFF0, QueueEventKind::link_update}};
    QueueTake queues{events, 9};
    std::array<ToolOutput, 1> tool_outputs{};
    std::array<PairOutput, 1> pair_outputs{};
    std::array<ModelOutput, 1> model_outputs{};

    ExampleFrame()
    {
        tools[0].rotation << 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0;
        DeviceRecord& device = devices[0];
        device.pose = DevicePose{Vec3(31.0, 32.0, 33.0), Mat3::Identity()};
        device.velocity_m_per_s = Vec3(34.0, 35.0, 36.0);
        device.angular_velocity_rad_per_s = Vec3(37.0, 38.0, 39.0);
        device.buttons = 40;
        device.gripper_m = 41.0;
        device.measures_rotation = true;
        device.sent_n = Vec3(42.0, 43.0, 44.0);
        device.sent_nm = Vec3(45.0, 46.0, 47.0);
        device.sent_gripper_n = 48.0;
        changes[0].pose.translation_m = Vec3(0.125, 4.0, -8.0);
        changes[0].pose.scale = 1.5;
        changes[0].pose.revision = 21;
        changes[1] = changes[0];
        changes[1].kind = SceneChangeKind::object_comes;
        changes[1].number = 1;
        changes[1].generation = 7;
        changes[1].object = {ModelId{0}, {300.0, 0.4, 0.3, 0.5, 0.6, 1e-5, 1e-3}};
        changes[2] = changes[1];
        changes[2].kind = SceneChangeKind::object_feels;
        model_outputs[0].state_hash = 0x1234'5678'9ABC'DEF0ULL;
        tool_outputs[0].force_n = Vec3(0.0, 0.0, 1.0);
    }
    ExampleFrame(const ExampleFrame&) = delete;
    ExampleFrame& operator=(const ExampleFrame&) = delete;

    [[nodiscard]] FrameInput input() const { return {tools, changes, budgets, 123'456'789, edits}; }
    [[nodiscard]] FrameOutput output() const
    {
        return {tool_outputs, pair_outputs, model_outputs, {}, FrameFault::none, queues, {}};
    }
    /// Frame coded by `encoder`, in separate memory.
    [[nodiscard]] std::vector<std::byte> code(FrameEncoder& encoder) const
    {
        const auto coded = encoder.encode(input(), output(), devices);
        return {coded.begin(), coded.end()};
    }
};

inline constexpr FrameShape kExampleShape{1, 1};

/// One tool, one object, and a tiny model with pools of a few slots.
inline RecordedSetup example_setup(const TinyModel& model)
{
    RecordedSetup setup;
    setup.tools = {
        {0.01, 500.0, 8.0, 1.0, PointCore{}, false, 0.25, true, 0.75, 0.002, true, true}};
    setup.objects = {{ModelId{0}, {250.0, 0.5, 0.25, 1.5}}};
    setup.poses.resize(1);
    setup.poses[0].translation_m = Vec3(1.0, 2.0, 3.0);
    setup.capacities = {5, 2};
    setup.models = {{{4, 1, 400, 60, 40, false}, model.header, model.base}};
    setup.static_when_it_fits = true;
    setup.prediction = Prediction::quadratic;
    setup.force_tolerance_n = 0.0625;
    setup.compiler = "some compiler";
    setup.architecture = "some processor";
    setup.kernels = "some kernels";
    return setup;
}

/// Three frames, the first of which takes a chunk from the queues.
inline std::vector<std::byte> example_recording(const TinyModel& model,
                                                std::uint64_t lost_from = kNoFrame)
{
    constexpr ContentKey kChunk{ContentKind::chunk, 1};
    RecordingWriter writer(example_setup(model));
    FrameEncoder encoder;
    ExampleFrame frame;
    writer.add_piece(0, kChunk, model.piece(kChunk));
    writer.add_piece(0, kChunk, model.piece(kChunk)); // Evicted and resident again.
    for (int i = 0; i < 3; ++i)
    {
        writer.add_frame(frame.code(encoder));
        frame.queues.events = {};
    }
    writer.finish(lost_from);
    return writer.take_bytes();
}

} // namespace tactus::test
