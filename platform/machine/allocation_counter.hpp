// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>

namespace tactus
{

/// Proof that the haptic thread leaves the heap alone. Programs that link the object library
/// `tactus_allocation_counter` get their own malloc family, operator new included, that counts the
/// calls of marked threads and passes on to the C library's.
/// Under a sanitizer, which needs that place for itself, and without glibc nothing is counted and
/// available() says so: never take a count of zero for proof before asking.
namespace allocation_counter
{

/// Calls on the heap by the calling thread while it was marked.
struct HeapCalls
{
    std::uint64_t allocations{0}; ///< malloc and all its relatives; a realloc is one.
    std::uint64_t frees{0};       ///< Of anything but a null pointer.
};

[[nodiscard]] bool available() noexcept;

/// Marks the calling thread from here on, or no longer; what was counted stays.
void mark_this_thread(bool marked) noexcept;

/// About 1 ns.
[[nodiscard]] HeapCalls of_this_thread() noexcept;

} // namespace allocation_counter

} // namespace tactus
