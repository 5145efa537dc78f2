// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// No input ends the process: tools without free space, hands at rest and exactly along walls.

#include "tests/shared/random.hpp"
#include "tests/shared/trial_length.hpp"
#include "tests/stability/no_room_trial.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>

namespace tactus::test
{

namespace
{

class NoRoom : public testing::TestWithParam<std::size_t>
{
};

TEST_P(NoRoom, ends_no_process_and_leaves_every_force_finite_and_in_range)
{
    const std::uint32_t frames = has_full_trials() ? 25'000 : 1'000;
    for (const bool has_friction : {false, true})
    {
        const TrialFigures sut = run_no_room_trial(cramped_tools()[GetParam()], has_friction,
                                                   frames, seed_of(20'261'600));
        std::printf("%s\n", sut.summary().c_str());
        EXPECT_TRUE(sut.holds());
    }
}

INSTANTIATE_TEST_SUITE_P(tools, NoRoom, testing::Range<std::size_t>(0, cramped_tools().size()));

} // namespace

} // namespace tactus::test
