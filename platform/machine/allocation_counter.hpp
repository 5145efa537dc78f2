// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstdint>

namespace tactus
{

/// Counts heap calls, to prove that the haptic thread makes none. Programs that link the object
/// library `tactus_allocation_counter` get their own malloc family, operator new included. It
/// counts the calls of marked threads and passes them to the C library. Under a sanitizer, which
/// replaces malloc itself, and without glibc nothing is counted and available() is false. Check it
/// before taking a count of zero as proof.
namespace allocation_counter
{

/// Heap calls of the calling thread while it was marked.
struct HeapCalls
{
    std::uint64_t allocations{0}; ///< Calls of malloc and its relatives; a realloc is one.
    std::uint64_t frees{0};       ///< Frees of non-null pointers.
};

[[nodiscard]] bool available() noexcept;

/// Marks or unmarks the calling thread; counts are kept.
void mark_this_thread(bool marked) noexcept;

/// Counts of the calling thread. About 1 ns.
[[nodiscard]] HeapCalls of_this_thread() noexcept;

} // namespace allocation_counter

} // namespace tactus
