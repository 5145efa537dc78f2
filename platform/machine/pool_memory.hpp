// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <cstddef>
#include <span>

// One thread, before the loop: asks the system for memory. The span may be lent to any thread.
namespace tactus
{

/// Memory of all pools: one allocation at start-up, aligned to a huge page. All bytes are set to
/// zero, so that every page is present. Throws std::bad_alloc if the system has no memory left.
///
/// The memory is on huge pages if the system grants them. Without them a traversal of many
/// megabytes misses the translation cache (TLB) at nearly every block. A frame with cold caches
/// then walks the page tables, too. The system may take up to kHugePage - 1 bytes more than
/// requested.
class PoolMemory
{
public:
    static constexpr std::size_t kHugePage = std::size_t{2} << 20U;

    /// `bytes` is rounded up to whole cache lines.
    explicit PoolMemory(std::size_t bytes);
    PoolMemory(const PoolMemory&) = delete;
    PoolMemory& operator=(const PoolMemory&) = delete;
    ~PoolMemory();

    [[nodiscard]] std::span<std::byte> span() const noexcept { return {memory_, bytes_}; }

private:
    std::size_t bytes_;
    std::byte* memory_;
};

} // namespace tactus
