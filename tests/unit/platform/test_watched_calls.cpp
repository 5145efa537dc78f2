// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/allocation_counter.hpp"
#include "platform/machine/posix/posix_clock.hpp"
#include "platform/machine/system_call_trap.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <malloc.h>
#include <memory>
#include <string>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <thread>
#include <unistd.h>

namespace tactus
{
namespace
{

using allocation_counter::HeapCalls;

/// Keeps the compiler from removing an allocation without a use.
void keep(void* block)
{
    asm volatile("" : : "r"(block) : "memory");
}

HeapCalls calls_during(const std::function<void()>& work)
{
    const HeapCalls before = allocation_counter::of_this_thread();
    allocation_counter::mark_this_thread(true);
    work();
    allocation_counter::mark_this_thread(false);
    const HeapCalls after = allocation_counter::of_this_thread();
    return {after.allocations - before.allocations, after.frees - before.frees};
}

struct AllocationCounter : testing::Test
{
    void SetUp() override
    {
        if (!allocation_counter::available())
        {
            GTEST_SKIP() << "allocation counter: not available under a sanitizer or without glibc";
        }
    }
};

TEST_F(AllocationCounter, counts_nothing_while_nothing_is_allocated)
{
    int sum = 0;
    const HeapCalls calls = calls_during(
        [&]
        {
            for (int i = 0; i < 1'000; ++i)
            {
                sum += i;
            }
        });
    EXPECT_EQ(calls.allocations, 0U);
    EXPECT_EQ(calls.frees, 0U);
    EXPECT_EQ(sum, 499'500);
}

TEST_F(AllocationCounter, counts_each_member_of_the_malloc_family_once)
{
    const HeapCalls calls = calls_during(
        []
        {
            void* a = std::malloc(16);
            keep(a);
            a = std::realloc(a, 4'096);
            keep(a);
            void* b = std::calloc(4, 4);
            keep(b);
            void* c = std::aligned_alloc(64, 128);
            keep(c);
            void* d = memalign(64, 128);
            keep(d);
            void* e = nullptr;
            EXPECT_EQ(posix_memalign(&e, 256, 128), 0);
            keep(e);
            void* f = reallocarray(nullptr, 3, 5);
            keep(f);
            for (void* block : {a, b, c, d, e, f})
            {
                std::free(block);
            }
        });
    EXPECT_EQ(calls.allocations, 7U);
    EXPECT_EQ(calls.frees, 6U);
}

TEST_F(AllocationCounter, counts_operator_new_and_delete)
{
    struct alignas(128) Wide
    {
        char bytes[128];
    };
    const HeapCalls calls = calls_during(
        []
        {
            const auto one = std::make_unique<int>(1);
            keep(one.get());
            const auto array = std::make_unique<int[]>(10);
            keep(array.get());
            const auto wide = std::make_unique<Wide>();
            keep(wide.get());
        });
    EXPECT_EQ(calls.allocations, 3U);
    EXPECT_EQ(calls.frees, 3U);
}

TEST_F(AllocationCounter, counts_allocations_made_inside_the_standard_library)
{
    const HeapCalls calls = calls_during(
        []
        {
            std::string text(1'000, 'x');
            keep(text.data());
        });
    EXPECT_EQ(calls.allocations, 1U);
    EXPECT_EQ(calls.frees, 1U);
}

TEST_F(AllocationCounter, leaves_unmarked_threads_alone)
{
    const HeapCalls before = allocation_counter::of_this_thread();
    keep(std::make_unique<int>(1).get());
    EXPECT_EQ(allocation_counter::of_this_thread().allocations, before.allocations);
}

TEST_F(AllocationCounter, keeps_the_threads_apart)
{
    const HeapCalls here = allocation_counter::of_this_thread();
    HeapCalls there;
    std::thread other([&] { there = calls_during([] { keep(std::make_unique<int>(1).get()); }); });
    other.join();
    EXPECT_EQ(there.allocations, 1U);
    EXPECT_EQ(allocation_counter::of_this_thread().allocations, here.allocations);
}

TEST_F(AllocationCounter, does_not_count_the_free_of_a_null_pointer)
{
    void* volatile nothing = nullptr;
    EXPECT_EQ(calls_during([&] { std::free(nothing); }).frees, 0U);
}

TEST_F(AllocationCounter, passes_alignment_and_refusals_on)
{
    void* block = nullptr;
    EXPECT_EQ(posix_memalign(&block, 24, 8), EINVAL); // Not a power of two.
    EXPECT_EQ(posix_memalign(&block, 0, 8), EINVAL);
    EXPECT_EQ(posix_memalign(&block, 4'096, 8), 0);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block) % 4'096, 0U);
    std::free(block);
    volatile std::size_t many = std::numeric_limits<std::size_t>::max() / 2;
    errno = 0;
    EXPECT_EQ(reallocarray(nullptr, many, 4), nullptr);
    EXPECT_EQ(errno, ENOMEM);
}

using system_call_trap::mark_frame;
using system_call_trap::of_this_thread;
using system_call_trap::TrappedCalls;

/// Runs the work on a separate thread with the trap set, since a trap is permanent.
void with_trap(const std::function<void()>& work)
{
    std::string refused;
    std::thread thread(
        [&]
        {
            if (const auto set = system_call_trap::set_on_this_thread(); !set)
            {
                refused = set.error().text;
                return;
            }
            work();
        });
    thread.join();
    if (!refused.empty())
    {
        GTEST_SKIP() << refused;
    }
}

TEST(SystemCallTrap, counts_a_planted_call_of_a_frame_and_tells_its_number)
{
    with_trap(
        []
        {
            const TrappedCalls before = of_this_thread();
            mark_frame(true);
            const long first = syscall(SYS_getppid);
            static_cast<void>(syscall(SYS_gettid));
            mark_frame(false);
            const TrappedCalls after = of_this_thread();
            EXPECT_EQ(before.in_frame, 0U);
            EXPECT_EQ(before.first_in_frame, -1);
            EXPECT_EQ(after.in_frame, 2U);
            EXPECT_EQ(after.first_in_frame, SYS_getppid);
            EXPECT_EQ(after.outside, before.outside);
            EXPECT_EQ(first, getppid()) << "the call is made all the same";
        });
}

TEST(SystemCallTrap, counts_no_call_of_a_frame_that_makes_none)
{
    with_trap(
        []
        {
            volatile double sum = 0.0;
            mark_frame(true);
            for (int i = 0; i < 100'000; ++i)
            {
                sum = sum + 0.5;
            }
            mark_frame(false);
            EXPECT_EQ(of_this_thread().in_frame, 0U);
            EXPECT_EQ(sum, 50'000.0);
        });
}

TEST(SystemCallTrap, tells_calls_between_frames_from_calls_in_them)
{
    with_trap(
        []
        {
            const TrappedCalls before = of_this_thread();
            for (int i = 0; i < 10; ++i)
            {
                static_cast<void>(syscall(SYS_getppid));
                mark_frame(true);
                mark_frame(false);
            }
            EXPECT_EQ(of_this_thread().outside, before.outside + 10);
            EXPECT_EQ(of_this_thread().in_frame, 0U);
        });
}

TEST(SystemCallTrap, sees_a_heap_that_grows_in_a_frame)
{
    with_trap(
        []
        {
            mark_frame(true);
            // NOLINTNEXTLINE(cppcoreguidelines-no-malloc): what the trap has to see.
            auto* block = static_cast<volatile char*>(std::malloc(std::size_t{64} << 20U));
            mark_frame(false);
            ASSERT_NE(block, nullptr);
            block[12'345'678] = 7;
            EXPECT_EQ(block[12'345'678], 7);
            EXPECT_GT(of_this_thread().in_frame, 0U);
            std::free(const_cast<char*>(block)); // NOLINT(cppcoreguidelines-no-malloc)
        });
}

TEST(SystemCallTrap, leaves_results_errors_and_all_six_arguments_as_they_are)
{
    with_trap(
        []
        {
            errno = 0;
            EXPECT_EQ(close(-1), -1);
            EXPECT_EQ(errno, EBADF);

            std::array<int, 2> ends{};
            ASSERT_EQ(pipe(ends.data()), 0);
            EXPECT_EQ(write(ends[1], "tactus", 6), 6);
            std::array<char, 8> text{};
            EXPECT_EQ(read(ends[0], text.data(), text.size()), 6);
            EXPECT_STREQ(text.data(), "tactus");
            EXPECT_EQ(close(ends[0]), 0);
            EXPECT_EQ(close(ends[1]), 0);

            void* mapped =
                mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
            ASSERT_NE(mapped, MAP_FAILED);
            *static_cast<volatile char*>(mapped) = 1;
            EXPECT_EQ(munmap(mapped, 4096), 0);
        });
}

TEST(SystemCallTrap, lets_a_sleep_last)
{
    with_trap(
        []
        {
            const TrappedCalls before = of_this_thread();
            const auto start = std::chrono::steady_clock::now();
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(20));
            EXPECT_GT(of_this_thread().outside, before.outside);
        });
}

/// None of them is a system call with the vDSO; without it every one is.
TEST(SystemCallTrap, counts_all_clock_reads_or_none)
{
    with_trap(
        []
        {
            const PosixClock clock;
            static_cast<void>(clock.now()); // A sanitizer looks up the function first.
            mark_frame(true);
            for (int i = 0; i < 100; ++i)
            {
                static_cast<void>(clock.now());
            }
            mark_frame(false);
            const std::uint64_t counted = of_this_thread().in_frame;
            EXPECT_TRUE(counted == 0 || counted == 100) << counted;
        });
}

TEST(SystemCallTrap, is_of_one_thread_alone)
{
    std::atomic<bool> other_may_end{false};
    TrappedCalls of_other;
    std::thread other(
        [&]
        {
            mark_frame(true);
            while (!other_may_end.load())
            {
                static_cast<void>(syscall(SYS_getppid));
            }
            mark_frame(false);
            of_other = of_this_thread();
        });
    with_trap([] { EXPECT_GT(syscall(SYS_gettid), 0); });
    other_may_end.store(true);
    other.join();
    EXPECT_EQ(of_other.in_frame + of_other.outside, 0U);
    EXPECT_EQ(of_this_thread().in_frame + of_this_thread().outside, 0U);
}

TEST(SystemCallTrap, counts_once_when_it_was_set_twice)
{
    with_trap(
        []
        {
            ASSERT_TRUE(system_call_trap::set_on_this_thread());
            mark_frame(true);
            static_cast<void>(syscall(SYS_getppid));
            mark_frame(false);
            EXPECT_EQ(of_this_thread().in_frame, 1U);
        });
}

} // namespace
} // namespace tactus
