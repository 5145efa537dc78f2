// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/thread_usage.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <sys/mman.h>
#include <thread>
#include <unistd.h>

namespace tactus
{
namespace
{

TEST(ThreadUsage, counts_a_fault_for_every_page_touched_first)
{
    constexpr std::size_t kPages = 16;
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    void* mapped =
        mmap(nullptr, kPages * page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(mapped, MAP_FAILED);
    ASSERT_EQ(madvise(mapped, kPages * page, MADV_NOHUGEPAGE), 0);
    auto* bytes = static_cast<volatile char*>(mapped);
    const ThreadUsage before = read_thread_usage();
    for (std::size_t i = 0; i < kPages; ++i)
    {
        bytes[i * page] = 1;
    }
    const ThreadUsage used = read_thread_usage() - before;
    EXPECT_GE(used.minor_faults, static_cast<std::int64_t>(kPages));
    EXPECT_EQ(munmap(mapped, kPages * page), 0);
}

TEST(ThreadUsage, counts_a_voluntary_switch_for_every_sleep)
{
    const ThreadUsage before = read_thread_usage();
    for (int i = 0; i < 20; ++i)
    {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    // A delayed thread may find its sleep already over, and does not switch.
    EXPECT_GE((read_thread_usage() - before).voluntary_switches, 10);
}

TEST(ThreadUsage, counts_time_on_the_processor_and_none_for_sleep)
{
    const ThreadUsage before = read_thread_usage();
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    const ThreadUsage slept = read_thread_usage();
    EXPECT_LT((slept - before).cpu_time, milliseconds(50));
    while ((read_thread_usage() - slept).cpu_time < milliseconds(5))
    {
    }
    EXPECT_GE((read_thread_usage() - slept).cpu_time, milliseconds(5));
}

TEST(ThreadUsage, is_of_the_calling_thread_alone)
{
    const ThreadUsage before = read_thread_usage();
    std::thread other(
        []
        {
            for (int i = 0; i < 50; ++i)
            {
                std::this_thread::sleep_for(std::chrono::microseconds(100));
            }
        });
    other.join();
    EXPECT_LT((read_thread_usage() - before).voluntary_switches, 50);
}

} // namespace
} // namespace tactus
