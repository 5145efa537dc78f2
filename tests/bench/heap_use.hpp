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

/// The calls on the heap that a function makes.
template <typename Function>
std::uint64_t allocations_of(const Function& function)
{
    const std::uint64_t before = allocation_counter::of_this_thread().allocations;
    allocation_counter::mark_this_thread(true);
    function();
    allocation_counter::mark_this_thread(false);
    return allocation_counter::of_this_thread().allocations - before;
}

/// A count of allocations_of(), or none where nothing is counted.
[[nodiscard]] inline std::optional<std::uint64_t> counted_if_available(std::uint64_t allocations)
{
    return allocation_counter::available() ? std::optional(allocations) : std::nullopt;
}

/// What the heap has given out and not got back, its own bookkeeping included: of the process's
/// main thread and of all that was mapped on its own. Always 0 under a sanitizer.
[[nodiscard]] inline std::size_t heap_bytes()
{
    const struct mallinfo2 now = ::mallinfo2();
    return now.uordblks + now.hblkhd;
}

} // namespace tactus::bench
