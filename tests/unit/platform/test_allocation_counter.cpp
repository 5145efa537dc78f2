// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/allocation_counter.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <limits>
#include <malloc.h>
#include <memory>
#include <string>
#include <thread>

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

} // namespace
} // namespace tactus
