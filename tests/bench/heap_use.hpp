// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/machine/allocation_counter.hpp"

#include <cstddef>
#include <cstdint>
#include <malloc.h>
#include <optional>

namespace tactus::bench
{

/// Heap calls of a function.
template <typename Function>
std::uint64_t allocations_of(const Function& function)
{
    const std::uint64_t before = allocation_counter::of_this_thread().allocations;
    allocation_counter::mark_this_thread(true);
    function();
    allocation_counter::mark_this_thread(false);
    return allocation_counter::of_this_thread().allocations - before;
}

/// Count of allocations_of(); empty if allocations are not counted.
[[nodiscard]] inline std::optional<std::uint64_t> counted_if_available(std::uint64_t allocations)
{
    return allocation_counter::available() ? std::optional(allocations) : std::nullopt;
}

/// Bytes in use on the heap, with its own bookkeeping: of the process's main thread and of separate
/// mappings. Always 0 under a sanitizer.
[[nodiscard]] inline std::size_t heap_bytes()
{
    const struct mallinfo2 now = ::mallinfo2();
    return now.uordblks + now.hblkhd;
}

} // namespace tactus::bench
