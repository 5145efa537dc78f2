// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/diagnose/doctor/machine_view.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <ctime>
#include <sched.h>
#include <sys/resource.h>

namespace tactus::doctor
{

namespace
{

TEST(Measured, agrees_with_the_system)
{
    const Measured measured = measure();
    rlimit limit{};
    ASSERT_EQ(getrlimit(RLIMIT_RTPRIO, &limit), 0);
    EXPECT_EQ(measured.rtprio_limit, limit.rlim_cur);
    timespec resolution{};
    ASSERT_EQ(clock_getres(CLOCK_MONOTONIC, &resolution), 0);
    EXPECT_EQ(measured.clock_resolution_ns, resolution.tv_nsec);
    EXPECT_FALSE(measured.user.empty());
    EXPECT_FALSE(measured.machine.empty());
    EXPECT_FALSE(measured.kernel_version.empty());
    EXPECT_TRUE(measured.float_control_is_default);
    if (measured.clock_calls)
    {
        EXPECT_LE(*measured.clock_calls, Measured::kClockReads);
    }
}

TEST(Measured, finds_the_same_again_and_keeps_the_threads_policy)
{
    const Measured first = measure();
    const Measured second = measure();
    EXPECT_EQ(first.fifo_refused, second.fifo_refused);
    EXPECT_EQ(first.memory_lock_granted, second.memory_lock_granted);
    EXPECT_EQ(first.clock_calls, second.clock_calls);
    EXPECT_EQ(sched_getscheduler(0), SCHED_OTHER);
}

TEST(Measured, takes_the_configuration_of_dds_from_the_environment)
{
    ::setenv("CYCLONEDDS_URI", "<CycloneDDS/>", 1);
    EXPECT_EQ(measure().dds_uri, "<CycloneDDS/>");
    ::unsetenv("CYCLONEDDS_URI");
    EXPECT_EQ(measure().dds_uri, "");
}

TEST(Measured, tells_the_limit_of_locked_memory)
{
    rlimit before{};
    ASSERT_EQ(getrlimit(RLIMIT_MEMLOCK, &before), 0);
    rlimit none = before;
    none.rlim_cur = 0;
    ASSERT_EQ(setrlimit(RLIMIT_MEMLOCK, &none), 0);
    const Measured measured = measure();
    ASSERT_EQ(setrlimit(RLIMIT_MEMLOCK, &before), 0);
    EXPECT_EQ(measured.memlock_limit, 0U);
}

} // namespace

} // namespace tactus::doctor
