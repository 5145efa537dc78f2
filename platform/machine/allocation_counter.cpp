// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/machine/allocation_counter.hpp"

#include <cerrno>
#include <cstddef>
#include <cstdlib>

// The build sets TACTUS_ALLOCATION_COUNTER: 1 to replace malloc, 0 otherwise.

namespace tactus::allocation_counter
{

namespace
{

// The variables are constant-initialised, so the first access allocates nothing; a thread's first
// access may come from inside malloc.
constinit thread_local bool thread_is_marked = false;
constinit thread_local HeapCalls thread_calls{};

#if TACTUS_ALLOCATION_COUNTER
void count_allocation() noexcept
{
    thread_calls.allocations += thread_is_marked ? 1 : 0;
}

void count_free(const void* block) noexcept
{
    thread_calls.frees += thread_is_marked && block != nullptr ? 1 : 0;
}

bool is_power_of_two(std::size_t value) noexcept
{
    return value != 0 && (value & (value - 1)) == 0;
}
#endif

} // namespace

bool available() noexcept
{
    return TACTUS_ALLOCATION_COUNTER != 0;
}

void mark_this_thread(bool marked) noexcept
{
    thread_is_marked = marked;
}

HeapCalls of_this_thread() noexcept
{
    return thread_calls;
}

} // namespace tactus::allocation_counter

#if TACTUS_ALLOCATION_COUNTER

// These are the C library's signatures, and its names for its own functions.
// NOLINTBEGIN(bugprone-reserved-identifier)
extern "C"
{

    using tactus::allocation_counter::count_allocation;
    using tactus::allocation_counter::count_free;
    using tactus::allocation_counter::is_power_of_two;

    void* __libc_malloc(std::size_t bytes) noexcept;
    void* __libc_calloc(std::size_t count, std::size_t bytes) noexcept;
    void* __libc_realloc(void* block, std::size_t bytes) noexcept;
    void* __libc_memalign(std::size_t alignment, std::size_t bytes) noexcept;
    void __libc_free(void* block) noexcept;

    void* malloc(std::size_t bytes) noexcept
    {
        count_allocation();
        return __libc_malloc(bytes);
    }

    void* calloc(std::size_t count, std::size_t bytes) noexcept
    {
        count_allocation();
        return __libc_calloc(count, bytes);
    }

    void* realloc(void* block, std::size_t bytes) noexcept
    {
        count_allocation();
        return __libc_realloc(block, bytes);
    }

    void* reallocarray(void* block, std::size_t count, std::size_t bytes) noexcept
    {
        count_allocation();
        std::size_t total = 0;
        if (__builtin_mul_overflow(count, bytes, &total))
        {
            errno = ENOMEM;
            return nullptr;
        }
        return __libc_realloc(block, total);
    }

    void* memalign(std::size_t alignment, std::size_t bytes) noexcept
    {
        count_allocation();
        return __libc_memalign(alignment, bytes);
    }

    void* aligned_alloc(std::size_t alignment, std::size_t bytes) noexcept
    {
        count_allocation();
        return __libc_memalign(alignment, bytes);
    }

    int posix_memalign(void** block, std::size_t alignment, std::size_t bytes) noexcept
    {
        count_allocation();
        if (alignment % sizeof(void*) != 0 || !is_power_of_two(alignment))
        {
            return EINVAL;
        }
        void* found = __libc_memalign(alignment, bytes);
        if (found == nullptr)
        {
            return ENOMEM;
        }
        *block = found;
        return 0;
    }

    void free(void* block) noexcept
    {
        count_free(block);
        __libc_free(block);
    }

} // extern "C"
// NOLINTEND(bugprone-reserved-identifier)

#endif
