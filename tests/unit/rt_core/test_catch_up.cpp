// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/force/catch_up.hpp"
#include "tests/shared/period.hpp"

#include <gtest/gtest.h>

namespace tactus::test
{

namespace
{

constexpr double kRate_n_per_s = 50.0;
constexpr double kMost_n = 10.0;
constexpr double kStep_n = kRate_n_per_s * kPeriod_s;

Vec3 next(CatchUp& sut, const Vec3& wanted_n, bool has_waited, double by_device_n = 0.0)
{
    return sut.next({wanted_n, by_device_n, kMost_n, kRate_n_per_s, kPeriod_s, has_waited});
}

TEST(CatchUp, lets_any_force_through_to_the_last_bit_that_never_waited)
{
    CatchUp sut;
    for (const Vec3& wanted_n : {Vec3(0.1, 0.2, 8.0), Vec3(0, 0, 0), Vec3(-3.0, 0.3, 1e-9)})
    {
        EXPECT_EQ(next(sut, wanted_n, false), wanted_n);
    }
}

TEST(CatchUp, goes_to_the_wanted_force_step_by_step_after_a_wait)
{
    CatchUp sut;
    sut.follow(Vec3(0, 0, 1));
    const Vec3 wanted_n(1, 0, 2);
    Vec3 before_n(0, 0, 1);
    int frames = 0;
    for (bool waited = true; before_n != wanted_n && frames < 1'000; waited = false, ++frames)
    {
        const Vec3 sent_n = next(sut, wanted_n, waited);
        ASSERT_LE((sent_n - before_n).norm(), kStep_n + 1e-12);
        ASSERT_LT((wanted_n - sent_n).norm(), (wanted_n - before_n).norm());
        before_n = sent_n;
    }
    EXPECT_EQ(frames, 29); // The square root of 2 over 0.05, rounded up.
}

TEST(CatchUp, what_the_hand_may_have_done_is_felt_at_once)
{
    CatchUp sut;
    EXPECT_NEAR(next(sut, Vec3(0, 0, 4), true, 0.3).z(), 0.3 + kStep_n, 1e-12);
    EXPECT_NEAR(next(sut, Vec3(0, 0, 5), false).z(), 1.3 + 2.0 * kStep_n, 1e-12);
    EXPECT_EQ(next(sut, Vec3(0, 0, 1), true, 0.5).z(), 1.0);
}

TEST(CatchUp, stays_within_the_longest)
{
    CatchUp sut;
    sut.follow(Vec3(0, 9, 0));
    EXPECT_LE(next(sut, Vec3(0, 0, 9), true).norm(), kMost_n);
    EXPECT_NEAR(next(sut, Vec3(0, 9, 0), false).norm(), kMost_n, 1e-12);
}

TEST(CatchUp, begins_anew_from_what_went_out_instead)
{
    CatchUp sut;
    (void)next(sut, Vec3(0, 0, 4), true);
    sut.follow(Vec3(0, 0, 3));
    EXPECT_EQ(next(sut, Vec3(0, 0, 4), false), Vec3(0, 0, 4));
    sut.follow(Vec3(0, 0, 3));
    EXPECT_NEAR(next(sut, Vec3(0, 0, 4), true).z(), 3.0 + kStep_n, 1e-12);
}

} // namespace

} // namespace tactus::test
