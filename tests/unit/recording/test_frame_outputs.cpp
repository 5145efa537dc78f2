// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/recording/frame_tap.hpp"
#include "platform/recording/last_inputs.hpp"
#include "platform/recording/recording.hpp"
#include "platform/recording/recording_format.hpp"
#include "tests/unit/recording/recorded_example.hpp"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <set>
#include <thread>
#include <vector>

namespace tactus::test
{
namespace
{

void record(FrameTap& tap, ExampleFrame& frame, std::int64_t number)
{
    frame.tools[0].sample_time_ns = number;
    tap.record(frame.input(), frame.output());
}

/// Takes all waiting frames; returns the numbers that record() gave them.
std::vector<std::int64_t> take_all(FrameTap& tap, FrameDecoder& decoder)
{
    std::vector<std::int64_t> numbers;
    for (std::vector<std::byte> coded; tap.try_take(coded);)
    {
        ByteReader reader(coded);
        EXPECT_EQ(decoder.decode(reader), nullptr);
        EXPECT_TRUE(reader.at_end());
        numbers.push_back(decoder.frame().tools[0].sample_time_ns);
    }
    return numbers;
}

TEST(FrameTap, has_nothing_before_a_frame_was_recorded)
{
    FrameTap sut(16);
    std::vector<std::byte> coded;
    EXPECT_FALSE(sut.try_take(coded));
    EXPECT_EQ(sut.lost_from(), kNoFrame);
}

TEST(FrameTap, loses_all_frames_from_the_first_that_finds_no_room)
{
    ExampleFrame frame;
    FrameEncoder encoder;
    const std::size_t first_cells = (frame.code(encoder).size() + 63) / 64;
    FrameTap sut(first_cells + 2); // The others take more than two.
    FrameDecoder decoder(kExampleShape);
    record(sut, frame, 0);
    EXPECT_EQ(sut.lost_from(), kNoFrame);
    record(sut, frame, 1);
    EXPECT_EQ(sut.lost_from(), 1U);
    EXPECT_EQ(take_all(sut, decoder), std::vector<std::int64_t>{0});
    record(sut, frame, 2); // There is space again, but a replay cannot pass the gap.
    EXPECT_TRUE(take_all(sut, decoder).empty());
    EXPECT_EQ(sut.lost_from(), 1U);
}

TEST(LastInputs, keeps_the_newest_in_order)
{
    const TinyModel model = make_tiny_model({});
    for (const std::int64_t frames : {0, 1, 4, 5, 6, 1'003})
    {
        LastInputs sut(2, 11); // Five frames, and one sample too few for a sixth.
        std::array<ToolState, 2> tools{};
        std::array<DeviceRecord, 2> devices{};
        for (std::int64_t number = 0; number < frames; ++number)
        {
            tools[0].sample_time_ns = number;
            tools[1].position_m.x() = static_cast<double>(number);
            devices[1].buttons = static_cast<std::uint32_t>(number);
            sut.keep({tools, {}, {}, number}, devices);
        }
        RecordedSetup setup = example_setup(model);
        setup.tools.resize(2);
        RecordingWriter writer(setup);
        sut.write_to(writer);
        writer.finish(kNoFrame);
        EXPECT_EQ(writer.frames(), static_cast<std::uint64_t>(std::min<std::int64_t>(frames, 5)));
        const auto recording = Recording::parse(writer.take_bytes(), "last.rec");
        ASSERT_TRUE(recording) << recording.error().text;
        FrameDecoder decoder(recording.value().shape());
        std::int64_t number = std::max<std::int64_t>(frames - 5, 0);
        for (ByteReader reader(recording.value().frames()); !reader.at_end(); ++number)
        {
            ASSERT_EQ(decoder.decode(reader), nullptr);
            EXPECT_FALSE(decoder.frame().has_hashes);
            EXPECT_EQ(decoder.frame().now_ns, number);
            EXPECT_EQ(decoder.frame().tools[0].sample_time_ns, number);
            EXPECT_EQ(decoder.frame().tools[1].position_m.x(), static_cast<double>(number));
            EXPECT_EQ(decoder.frame().devices[1].buttons, static_cast<std::uint32_t>(number));
        }
        EXPECT_EQ(number, frames);
    }
}

TEST(FrameTap, of_a_run_ends_with_the_frame_that_failed_unless_one_is_lost)
{
    ExampleFrame frame;
    FrameTap sut(64);
    FrameDecoder decoder(kExampleShape);
    record(sut, frame, 0);
    frame.tools[0].sample_time_ns = 1;
    sut.record_failed({frame.input(), frame.queues, frame.devices});
    EXPECT_EQ(take_all(sut, decoder), (std::vector<std::int64_t>{0, 1}));
    EXPECT_FALSE(decoder.frame().has_hashes);
    EXPECT_EQ(decoder.frame().events.size(), frame.events.size());

    FrameTap full(2);
    record(full, frame, 0);
    full.record_failed({frame.input(), frame.queues, frame.devices});
    EXPECT_EQ(full.lost_from(), 0U);
    EXPECT_TRUE(take_all(full, decoder).empty());
}

TEST(FrameTap, carries_frames_between_threads)
{
    constexpr std::int64_t kFrames = 2'000;
    FrameTap sut(128);
    FrameDecoder decoder(kExampleShape);
    std::atomic<std::int64_t> taken{0};
    std::thread producer(
        [&]
        {
            ExampleFrame frame;
            for (std::int64_t number = 0; number < kFrames; ++number)
            {
                while (number - taken.load() > 4) // Within the capacity of the queue.
                {
                    std::this_thread::yield();
                }
                record(sut, frame, number);
            }
        });
    while (taken.load() < kFrames)
    {
        for (const std::int64_t number : take_all(sut, decoder))
        {
            ASSERT_EQ(number, taken.load());
            taken.store(number + 1);
        }
    }
    producer.join();
    EXPECT_EQ(sut.lost_from(), kNoFrame);
}

struct Outputs
{
    std::array<ToolOutput, 1> tools{};
    std::array<PairOutput, 1> pairs{};
    std::array<ModelOutput, 1> models{};
    WorkCounters work;
    FrameFault faults{FrameFault::none};
    SceneOutput scene;

    [[nodiscard]] OutputHashes hashes() const
    {
        return hash_output({tools, pairs, models, work, faults, {}, scene});
    }
};

/// Part of the output with changes of it, one for each field that a frame sets.
struct Part
{
    std::uint64_t OutputHashes::*hash;
    std::vector<std::function<void(Outputs&)>> changes;
};

std::vector<Part> parts()
{
    using O = Outputs;
    const auto tool = [](auto change) { return [change](O& o) { change(o.tools[0]); }; };
    const auto pair = [](auto change) { return [change](O& o) { change(o.pairs[0]); }; };
    const auto model = [](auto change) { return [change](O& o) { change(o.models[0]); }; };
    const auto work = [](auto member) { return [member](O& o) { o.work.*member = 1; }; };
    return {
        {&OutputHashes::tools,
         {tool([](auto& t) { t.force_n.x() = 1.0; }),
          tool([](auto& t) { t.force_n.z() = -0.0; }),
          tool([](auto& t) { t.proxy_m.y() = 1.0; }),
          tool([](auto& t) { t.in_contact = true; }),
          tool([](auto& t) { t.halted = true; }),
          tool([](auto& t) { t.over_constrained = true; }),
          tool([](auto& t) { t.data_limited = true; }),
          tool([](auto& t) { t.under_way = true; }),
          tool([](auto& t) { t.cut_short = true; }),
          tool([](auto& t) { t.capacity_exceeded = true; }),
          tool([](auto& t) { t.lost_object = true; }),
          tool([](auto& t) { t.is_gone = true; }),
          tool([](auto& t) { t.clear_m = 1.0; }),
          tool([](auto& t) { t.stiffness_n_per_m = 1.0; }),
          tool([](auto& t) { t.lag_m = 1.0; }),
          tool([](auto& t) { t.object_way_m = 1.0; }),
          tool([](auto& t) { t.object_rotation_rad = 1.0; }),
          tool([](auto& t) { t.carried_m.x() = 1.0; }),
          tool([](auto& t) { t.carried_rad.z() = 1.0; }),
          tool([](auto& t) { t.sample_fault = FrameFault::tool_stuck; }),
          tool([](auto& t) { t.torque_nm.y() = 1.0; }),
          tool([](auto& t) { t.proxy_rotation(1, 2) = 1.0; })}},
        {&OutputHashes::pairs,
         {pair([](auto& p) { p.tool = 1; }), pair([](auto& p) { p.object = 1; }),
          pair([](auto& p) { p.kind = AnswerKind::stale; }),
          pair([](auto& p) { p.tool_m.y() = 1.0; }),
          pair([](auto& p) { p.tool_rotation(2, 1) = 1.0; }),
          pair([](auto& p) { p.point_m.x() = 1.0; }), pair([](auto& p) { p.lower_m = 1.0; }),
          pair([](auto& p) { p.upper_m = 1.0; }), pair([](auto& p) { p.certified_radius_m = 1.0; }),
          pair([](auto& p) { p.tolerated_m = 1.0; }),
          pair([](auto& p) { p.nearest_face = FaceId{1}; }),
          pair([](auto& p) { p.nearest_point_m.x() = 1.0; }),
          pair([](auto& p) { p.skipped = true; }), pair([](auto& p) { p.is_shed = true; }),
          pair([](auto& p) { p.is_joined = false; }),
          pair([](auto& p) { p.damping_n_s_per_m = 1.0; })}},
        {&OutputHashes::models,
         {model([](auto& m) { m.pages.used = 1; }), model([](auto& m) { m.pages.used_max = 1; }),
          model([](auto& m) { m.pages.capacity = 1; }),
          model([](auto& m) { m.index_pages.used = 1; }), model([](auto& m) { m.faces.used = 1; }),
          model([](auto& m) { m.blocks.used = 1; }), model([](auto& m) { m.nodes.used = 1; }),
          model([](auto& m) { m.refined_records = 1; }), model([](auto& m) { m.state_hash = 1; }),
          model([](auto& m) { m.is_static = true; }),
          model([](auto& m) { m.stage = ModelStage::known; }),
          model([](auto& m) { m.stage = ModelStage::wanted; }),
          model([](auto& m) { m.added.capacity = 1; }),
          model(
              [](auto& m) {
                  m.added = {1, 1, 2};
              }),
          model(
              [](auto& m)
              {
                  m.added.capacity = 1;
                  m.edit_revision = 1;
              })}},
        {&OutputHashes::work,
         {work(&WorkCounters::splits),
          work(&WorkCounters::merges),
          work(&WorkCounters::scanned),
          work(&WorkCounters::nodes_visited),
          work(&WorkCounters::triangles_tested),
          work(&WorkCounters::planes_looked_at),
          work(&WorkCounters::pages_adopted),
          work(&WorkCounters::requests),
          work(&WorkCounters::regions_searched),
          work(&WorkCounters::nodes_refitted),
          work(&WorkCounters::blocks_refitted),
          work(&WorkCounters::evictions),
          work(&WorkCounters::cache_hits),
          work(&WorkCounters::cache_misses),
          [](O& o) { o.work.budget.spend(1); },
          [](O& o) { o.scene.objects = 1; },
          [](O& o) { o.scene.pairs = 1; },
          [](O& o) { o.scene.tools_over_capacity = 1; },
          [](O& o) { o.scene.walled_tools = 1; },
          [](O& o) { o.scene.walks = 1; },
          [](O& o) { o.scene.refused[0] = 1; },
          [](O& o) { o.scene.refused[7] = 1; },
          [](O& o) { o.scene.edits_refused[0] = 1; },
          [](O& o) { o.scene.edits_refused[kEditRefusals - 1] = 1; },
          [](O& o) { o.work.skipped.add(Skip::models); },
          [](O& o) { o.work.skipped.add(Skip::boxes); },
          [](O& o) { o.faults = FrameFault::cache_full; }}}};
}

TEST(OutputHash, sees_every_field_in_its_part_and_tells_them_apart)
{
    const OutputHashes plain = Outputs{}.hashes();
    for (const Part& part : parts())
    {
        std::set<std::uint64_t> seen{plain.*part.hash};
        for (std::size_t i = 0; i < part.changes.size(); ++i)
        {
            Outputs changed;
            part.changes[i](changed);
            OutputHashes hashes = changed.hashes();
            EXPECT_TRUE(seen.insert(hashes.*part.hash).second) << i;
            hashes.*part.hash = plain.*part.hash;
            EXPECT_EQ(hashes, plain) << i; // The other parts are unchanged.
        }
    }
}

/// Second implementation of the definition: SplitMix64's finalizer over the values in turn.
TEST(OutputHash, is_what_the_format_page_says)
{
    std::uint64_t state = 0;
    // 15 counters, five of the scene, refusals of changes and edits, those of shortcuts and the
    // faults, all zero.
    for (std::size_t value = 0; value < 21 + kChangeRefusals + kEditRefusals + kSkips; ++value)
    {
        state += 0x9E3779B97F4A7C15U;
        state = (state ^ (state >> 30)) * 0xBF58476D1CE4E5B9U;
        state = (state ^ (state >> 27)) * 0x94D049BB133111EBU;
        state ^= state >> 31;
    }
    EXPECT_EQ(Outputs{}.hashes().work, state);
}

TEST(OutputHash, depends_on_how_many_there_are)
{
    const std::array<ToolOutput, 2> tools{};
    FrameOutput one;
    one.tools = std::span(tools).first(1);
    FrameOutput two;
    two.tools = tools;
    EXPECT_NE(hash_output(one).tools, hash_output(two).tools);
}

} // namespace
} // namespace tactus::test
