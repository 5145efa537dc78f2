// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/process_stop.hpp"
#include "platform/machine/thread_usage.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <sys/mman.h>
#include <sys/wait.h>
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

/// Result: 1 for the first answer, 2 for the second.
int look_twice()
{
    const int first = take_process_stop() ? 1 : 0;
    return first + (take_process_stop() ? 2 : 0);
}

/// Stops that a child detected, as its exit code.
int after_stops(int stops)
{
    const pid_t child = fork();
    if (child == 0)
    {
        watch_process_stops();
        for (int i = 0; i < stops; ++i)
        {
            static_cast<void>(raise(SIGSTOP));
        }
        _exit(look_twice());
    }
    int status = 0;
    while (waitpid(child, &status, WUNTRACED) == child && WIFSTOPPED(status))
    {
        kill(child, SIGCONT);
    }
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(ProcessStop, is_seen_once_however_often_the_process_was_stopped)
{
    EXPECT_EQ(after_stops(0), 0);
    EXPECT_EQ(after_stops(1), 1);
    EXPECT_EQ(after_stops(3), 1);
}

TEST(ProcessStop, is_seen_by_a_thread_that_was_started_later)
{
    sigset_t before;
    ASSERT_EQ(pthread_sigmask(SIG_BLOCK, nullptr, &before), 0);
    watch_process_stops();
    int seen = -1;
    std::thread later(
        [&seen]
        {
            kill(getpid(), SIGCONT); // SIGCONT works without a stop.
            seen = look_twice();
        });
    later.join();
    EXPECT_EQ(seen, 1);
    EXPECT_EQ(pthread_sigmask(SIG_SETMASK, &before, nullptr), 0);
}

} // namespace
} // namespace tactus
