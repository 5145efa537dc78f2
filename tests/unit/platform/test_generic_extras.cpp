// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/pool_memory.hpp"
#include "platform/machine/posix/linux_extras.hpp"
#include "platform/machine/posix/memory_lock.hpp"
#include "platform/machine/rt_thread.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string>

/// Platform of a system other than Linux: posix/generic_extras.cpp in place of the extras,
/// everything else unchanged.
namespace tactus
{
namespace
{

RtThreadOptions as_far_as_allowed()
{
    RtThreadOptions options;
    options.allow_no_rt = true;
    options.lock_memory = false;
    return options;
}

bool contains(const std::string& text, const std::string& part)
{
    return text.find(part) != std::string::npos;
}

TEST(GenericExtras, refuse_a_processor_and_say_why)
{
    RtThreadOptions options = as_far_as_allowed();
    options.cpu = 0;
    bool has_run = false;
    const auto refused = RtThread::start(options, [&] { has_run = true; });
    ASSERT_FALSE(refused);
    EXPECT_FALSE(has_run);
    EXPECT_TRUE(refused.error().is_usage);
    EXPECT_TRUE(contains(refused.error().text, "processor 0 can't be chosen"));
    EXPECT_TRUE(contains(refused.error().text, "leave the choice to the system"));
    EXPECT_EQ(linux_extras::another_cpu(0), std::nullopt);
}

TEST(GenericExtras, run_a_thread_on_whatever_processor_and_let_the_processors_sleep)
{
    bool has_run = false;
    auto started = RtThread::start(as_far_as_allowed(), [&] { has_run = true; });
    ASSERT_TRUE(started) << started.error().text;
    started.value().join();
    EXPECT_TRUE(has_run);
    EXPECT_FALSE(started.value().report().pinned);
    EXPECT_FALSE(started.value().report().processors_awake);
}

TEST(GenericExtras, tell_who_lacks_which_right_in_one_line)
{
    for (const std::string& line :
         {linux_extras::explain_fifo_refusal(80, EPERM), linux_extras::explain_lock_refusal(EPERM)})
    {
        EXPECT_TRUE(contains(line, "refused (EPERM): "));
        EXPECT_TRUE(contains(line, " lacks the right to "));
        EXPECT_FALSE(contains(line, "\n"));
    }
    EXPECT_TRUE(contains(linux_extras::explain_fifo_refusal(80, EPERM), "SCHED_FIFO 80"));
    EXPECT_TRUE(contains(linux_extras::explain_lock_refusal(EPERM), "mlockall"));
}

TEST(GenericExtras, lock_memory_without_a_limit_to_look_at)
{
    EXPECT_EQ(linux_extras::try_to_exceed_lock_limit(), 0);
    const std::optional<std::string> refusal = posix::lock_all_memory();
    if (!refusal)
    {
        posix::unlock_all_memory();
        return;
    }
    EXPECT_TRUE(contains(*refusal, "mlockall refused ("));
}

TEST(GenericExtras, leave_faults_and_switches_uncounted_but_not_the_time)
{
    const ThreadUsage before = read_thread_usage();
    while ((read_thread_usage() - before).cpu_time < milliseconds(2))
    {
    }
    const ThreadUsage used = read_thread_usage() - before;
    EXPECT_GE(used.cpu_time, milliseconds(2));
    EXPECT_EQ(used.minor_faults, 0);
    EXPECT_EQ(used.major_faults, 0);
    EXPECT_EQ(used.voluntary_switches, 0);
    EXPECT_EQ(used.involuntary_switches, 0);
}

TEST(GenericExtras, draw_other_random_bytes_each_time)
{
    std::array<std::byte, 32> first{};
    std::array<std::byte, 32> second{};
    ASSERT_TRUE(linux_extras::draw_random(first));
    ASSERT_TRUE(linux_extras::draw_random(second));
    EXPECT_NE(first, second);
    EXPECT_FALSE(std::ranges::all_of(first, [](std::byte byte) { return byte == std::byte{}; }));
}

TEST(GenericExtras, give_pools_in_ordinary_pages)
{
    const PoolMemory sut(100'000);
    EXPECT_GE(sut.span().size(), 100'000U);
    EXPECT_TRUE(
        std::ranges::all_of(sut.span(), [](std::byte byte) { return byte == std::byte{}; }));
}

} // namespace
} // namespace tactus
