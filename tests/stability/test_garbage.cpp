// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// A device that sends garbage yields a safe force, and the frame's faults report it.

#include "tests/stability/bracket_trial.hpp"
#include "tests/stability/garbage_trial.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#if defined(__x86_64__)
#include <xmmintrin.h>
#endif

namespace tactus::test
{

namespace
{

class DeviceGarbage : public testing::TestWithParam<std::size_t>
{
};

TEST_P(DeviceGarbage, gets_a_safe_force_and_is_told_of)
{
    const TestModel& model = small_model(0);
    const CenterOracle oracle(model);
    const TrialFigures sut = run_garbage_trial(model, oracle, garbage_kinds()[GetParam()], 4'000,
                                               seed_of(20'261'500 + GetParam()));
    std::printf("%s\n", sut.summary().c_str());
    EXPECT_TRUE(sut.holds());
}

INSTANTIATE_TEST_SUITE_P(kinds, DeviceGarbage, testing::Range<std::size_t>(0, kGarbageKinds));

TEST(DeviceGarbageOfABody, gets_a_safe_force_and_torque_and_is_told_of)
{
    for (const Garbage& garbage : rigid_garbage_kinds())
    {
        const TrialFigures sut = run_rigid_garbage_trial(garbage, 600, seed_of(20'261'540));
        EXPECT_TRUE(sut.holds()) << sut.summary();
    }
}

#if defined(__x86_64__)
/// A library built with -ffast-math may set both flags. The haptic thread resets and reports them,
/// and a frame that runs with them is still right.
TEST(FlushedDenormals, leave_brackets_true)
{
    const TestModel& model = small_model(0);
    const CenterOracle oracle(model);
    const unsigned before = _mm_getcsr();
    _mm_setcsr(before | 0x8040U);
    const BracketFigures sut = run_bracket_trial(
        {model, oracle.tree(), oracle, hardship_named(model, "usual"), seed_of(20'261'520), 1'000});
    _mm_setcsr(before);
    EXPECT_TRUE(sut.bounded.holds()) << sut.bounded.summary();
}
#endif

} // namespace

} // namespace tactus::test
