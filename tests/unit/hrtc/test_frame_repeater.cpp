// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/self_check.hpp"
#include "tests/shared/altered_recording.hpp"
#include "tests/shared/frame_rig.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace tactus::hrtc::test
{

namespace
{

constexpr std::uint64_t kFrames = 30;

/// Recording of a tool that descends on a small model.
const Recording& recorded_run()
{
    static const Recording kRecording = []
    {
        const tactus::test::TestModel& model = tactus::test::small_model(0);
        tactus::test::RigOptions options = tactus::test::with_room_for_all();
        options.record = true;
        options.tools = {{0.01 * model.diagonal_m, 500.0, 8.0, 1.0}};
        tactus::test::FrameRig rig(model, options);
        const Vec3 place = to_vec3(model.faces.front()[0]);
        for (std::uint64_t frame = 0; frame < kFrames; ++frame)
        {
            rig.step(place * (1.2 - 0.01 * static_cast<double>(frame)));
        }
        return std::move(Recording::parse(rig.finish_recording(), "run.rec")).value();
    }();
    return kRecording;
}

using Frames = std::vector<std::uint64_t>;

TEST(FrameRepeater, names_the_suspects_that_are_over_the_limit_again_and_no_other_frame)
{
    const auto over = frames_over_again(recorded_run(), Frames{3, 17, kFrames - 1}, nanoseconds(0));
    ASSERT_TRUE(over);
    EXPECT_EQ(over.value(), (Frames{3, 17, kFrames - 1}));
}

TEST(FrameRepeater, clears_those_that_never_are)
{
    const auto over = frames_over_again(recorded_run(), Frames{3, 17}, milliseconds(100'000));
    ASSERT_TRUE(over);
    EXPECT_TRUE(over.value().empty());
}

TEST(FrameRepeater, repeats_nothing_for_nobody)
{
    const auto over = frames_over_again(recorded_run(), {}, nanoseconds(0));
    ASSERT_TRUE(over);
    EXPECT_TRUE(over.value().empty());
}

TEST(FrameRepeater, refuses_a_frame_that_is_not_in_the_recording)
{
    const auto over = frames_over_again(recorded_run(), Frames{3, kFrames}, milliseconds(100'000));
    ASSERT_FALSE(over);
    EXPECT_EQ(over.error(), "frame 30 is not in the recording of 30 frames");
}

/// A replay that differs from the run proves nothing about it.
TEST(FrameRepeater, refuses_a_recording_that_comes_out_otherwise)
{
    const std::vector<std::byte> bytes =
        tactus::test::alter_frame(recorded_run(), 12, tactus::test::change_goal);
    const Recording altered = std::move(Recording::parse(bytes, "altered.rec")).value();
    const auto over = frames_over_again(altered, Frames{3}, milliseconds(100'000));
    ASSERT_FALSE(over);
    EXPECT_NE(over.error().find("frame 12"), std::string::npos) << over.error();
}

} // namespace

} // namespace tactus::hrtc::test
