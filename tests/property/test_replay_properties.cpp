// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Any run of the frame, under any hardship, replays bit for bit from its recording, and a replay
/// with one changed bit is detected.

#include "platform/recording/frame_encoder.hpp"
#include "tests/property/replay_checks.hpp"
#include "tests/shared/altered_recording.hpp"
#include "tests/stability/hardships.hpp"
#include "tests/stability/random_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>

namespace tactus::test
{
namespace
{

constexpr std::array kHardships{"usual", "starved", "small-pools", "lossy-link", "static"};

constexpr int kFrames = 400;

/// Records a run. Cache warming changes nothing, so the replay needs none.
std::vector<std::byte> record_run(const TestModel& model, const char* name, std::uint64_t seed)
{
    Random random = Random::seeded(seed);
    WanderingOperator wander(model, random);
    const Hardship hardship = hardship_named(model, name);
    RigOptions options = hardship.rig;
    options.faults.seed = seed;
    options.chunk_loader_steps_per_frame = 1 + random.below(4U);
    options.record = true;
    options.prediction = random.one_in(2) ? Prediction::automatic : Prediction::local_neighbours;
    FrameRig rig(model, options);
    Budgets budgets = hardship.budgets;
    for (int frame = 0; frame < kFrames; ++frame)
    {
        // Budgets change here as in a real run, where they follow the costs of frames.
        budgets.splits = frame % 50 == 49 ? 1U : hardship.budgets.splits;
        rig.frame().warm_caches();
        static_cast<void>(rig.step(wander.next(), budgets));
        for (std::size_t more = random.below(3); more > 0; --more)
        {
            rig.deliver();
        }
    }
    return rig.finish_recording();
}

class Replay : public testing::TestWithParam<std::tuple<std::size_t, std::size_t>>
{
protected:
    [[nodiscard]] static std::size_t model_index() { return std::get<0>(GetParam()); }
    [[nodiscard]] static const char* hardship() { return kHardships[std::get<1>(GetParam())]; }
};

TEST_P(Replay, gives_every_frame_again_bit_for_bit_and_without_rehearsals)
{
    const TestModel& model = small_model(model_index());
    const std::uint64_t seed = seed_of(500 + 10 * model_index() + std::get<1>(GetParam()));
    SCOPED_TRACE(model.name + " " + hardship() + " seed " + std::to_string(seed));
    expect_same_again(record_run(model, hardship(), seed), kFrames);
}

INSTANTIATE_TEST_SUITE_P(Runs, Replay,
                         testing::Combine(testing::Values(std::size_t{0}, std::size_t{2},
                                                          std::size_t{3}, std::size_t{5}),
                                          testing::Range(std::size_t{0}, kHardships.size())));

/// Slots move between two models, in pools that are too small for both.
TEST(ReplayOfTwoModels, gives_every_frame_again_though_they_take_each_other_s_slots)
{
    const TestModel& model = small_model(0);
    const std::uint64_t seed = seed_of(590);
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random = Random::seeded(seed);
    WanderingOperator wander(model, random);
    RigOptions options;
    options.pool_bytes = std::size_t{700} << 10U;
    options.cache_bytes = 10 * sizeof(Page);
    options.faults.delay_polls_max = 40;
    options.faults.seed = seed;
    options.chunk_loader_steps_per_frame = 2;
    options.objects = {{ModelId{0}}, {ModelId{1}}};
    options.record = true;
    FrameRig rig({&model, &model}, options);
    ObjectPose away;
    away.translation_m = Vec3(0.0, 0.0, 20.0 * model.diagonal_m);
    std::array<std::uint32_t, 2> most{};
    std::uint32_t evictions = 0;
    for (int frame = 0; frame < 2 * kFrames; ++frame)
    {
        const std::size_t touched = static_cast<std::size_t>(frame / 100) % 3;
        for (std::size_t i = 0; i < 2; ++i)
        {
            rig.place_object(touched == i ? away : ObjectPose{}, i); // Sometimes both are present.
        }
        const FrameOutput output = rig.step(wander.next(), {});
        evictions += output.work.evictions;
        for (std::size_t i = 0; i < 2; ++i)
        {
            most[i] = std::max(most[i], output.models[i].pages.used);
        }
        ASSERT_LE(output.models[0].pages.used + output.models[1].pages.used, 10U);
    }
    EXPECT_GT(evictions, 20U);
    EXPECT_GT(most[0], rig.model({0}).capacities.pages) << "it had its own pages only";
    EXPECT_GT(most[1], rig.model({1}).capacities.pages) << "it had its own pages only";
    expect_same_again(rig.finish_recording(), 2 * kFrames);
}

void expect_noticed(const std::vector<std::byte>& bytes, std::uint64_t frame)
{
    const auto replayed = replay(parsed(bytes));
    ASSERT_TRUE(replayed) << replayed.error().text;
    ASSERT_TRUE(replayed.value().difference.has_value());
    EXPECT_EQ(replayed.value().difference->frame, frame) << replayed.value().difference->text;
    EXPECT_EQ(replayed.value().frames, frame + 1);
}

TEST(ReplayOfAnAlteredRecording, is_noticed_in_the_frame_that_was_altered)
{
    const TestModel& model = small_model(0);
    const Recording recording = parsed(record_run(model, "usual", 900));
    const auto flip_from_end = [](std::size_t bytes) {
        return [bytes](std::span<std::byte> coded) { coded[coded.size() - bytes] ^= std::byte{1}; };
    };
    for (const std::uint64_t frame : {0U, 57U, 399U})
    {
        SCOPED_TRACE("frame " + std::to_string(frame));
        // The changes are the goal's x, a bit of the state hash, and one of the last output hash.
        expect_noticed(alter_frame(recording, frame, change_goal), frame);
        expect_noticed(alter_frame(recording, frame, flip_from_end(40)), frame);
        expect_noticed(alter_frame(recording, frame, flip_from_end(1)), frame);
    }
}

TEST(ReplayOfAnAlteredRecording, notices_another_budget_once_it_is_spent)
{
    const TestModel& model = small_model(0);
    const Recording recording = parsed(record_run(model, "usual", 900));
    constexpr std::size_t kTool = 38; // Bytes of a tool without rotation and device.
    const auto no_splits = [](std::span<std::byte> coded)
    { coded[4 + 1 + 8 + kTool] = std::byte{0}; };
    const auto parsed = Recording::parse(alter_frame(recording, 0, no_splits), "altered");
    ASSERT_TRUE(parsed) << parsed.error().text;

    const auto replayed = replay(parsed.value());

    ASSERT_TRUE(replayed) << replayed.error().text;
    EXPECT_TRUE(replayed.value().difference.has_value());
}

TEST(ReplayOfAnAlteredRecording, ends_whatever_its_frames_say)
{
    const TestModel& model = small_model(0);
    const Recording recording = parsed(record_run(model, "lossy-link", 900));
    const std::uint64_t seed = seed_of(901);
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random = Random::seeded(seed);
    int replayed_count = 0;
    for (int i = 0; i < 300; ++i)
    {
        const auto scribble = [&](std::span<std::byte> coded)
        {
            for (std::size_t more = random.below(4) + 1; more > 0; --more)
            {
                coded[4 + random.below(coded.size() - 4)] =
                    static_cast<std::byte>(random.below(256));
            }
        };
        const auto altered =
            Recording::parse(alter_frame(recording, random.below(kFrames), scribble), "altered");
        if (altered)
        {
            const auto replayed = replay(altered.value());
            ASSERT_TRUE(replayed) << replayed.error().text;
            EXPECT_TRUE(replayed.value().difference || replayed.value().frames == kFrames);
            ++replayed_count;
        }
    }
    EXPECT_GT(replayed_count, 100);
}

} // namespace
} // namespace tactus::test
