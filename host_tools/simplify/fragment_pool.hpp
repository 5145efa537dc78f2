// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/assert.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace tactus
{

/// A point of an original triangle: p0 + (x (p1 - p0) + y (p2 - p0)) / 2^31. Eight bytes instead of
/// 24; rounding moves it by at most 2^-31 of the triangle's longer side.
struct TrianglePoint
{
    static constexpr std::uint32_t kOne = 1U << 31U;

    std::uint32_t x{0};
    std::uint32_t y{0};

    constexpr bool operator==(const TrianglePoint&) const noexcept = default;
};

/// A part of an original triangle. The fragments of a triangle may be assigned to different faces.
struct Fragment
{
    std::array<TrianglePoint, 3> corners{};
    std::uint32_t triangle{0};
    /// Next fragment in the list of its face, or next free slot; kNone at the end.
    std::uint32_t next{0};
    /// Number of cuts that produced the fragment; each cut adds to the slack of its bound.
    std::uint32_t generation{0};
};

static_assert(sizeof(Fragment) == 36);

/// Pool of fragments, addressed by number. Each worker takes and returns slots through its own free
/// list. Another worker may read a fragment once the threads have been joined. Numbers depend on
/// the assignment of work to workers; results must not.
class FragmentPool
{
public:
    static constexpr std::uint32_t kNone = 0xFFFF'FFFFU;

    explicit FragmentPool(unsigned workers) : blocks_(kBlocksMax), lists_(workers) {}

    [[nodiscard]] Fragment& operator[](std::uint32_t index) noexcept
    {
        return (*blocks_[index / kBlockSize])[index % kBlockSize];
    }
    [[nodiscard]] const Fragment& operator[](std::uint32_t index) const noexcept
    {
        return (*blocks_[index / kBlockSize])[index % kBlockSize];
    }

    /// Takes a free slot for one fragment.
    [[nodiscard]] std::uint32_t take(unsigned worker)
    {
        FreeList& list = lists_[worker];
        if (list.head == kNone)
        {
            add_block(list);
        }
        const std::uint32_t index = list.head;
        list.head = (*this)[index].next;
        return index;
    }

    void give_back(unsigned worker, std::uint32_t index) noexcept
    {
        (*this)[index].next = lists_[worker].head;
        lists_[worker].head = index;
    }

private:
    static constexpr std::uint32_t kBlockSize = 1U << 13U;
    static constexpr std::uint32_t kBlocksMax = 1U << 16U; ///< Limit: 19 GB of fragments.

    using Block = std::array<Fragment, kBlockSize>;

    struct alignas(64) FreeList
    {
        std::uint32_t head{kNone};
    };

    void add_block(FreeList& list)
    {
        const std::lock_guard lock(mutex_);
        TACTUS_ASSERT(blocks_used_ < kBlocksMax);
        blocks_[blocks_used_] = std::make_unique<Block>();
        const std::uint32_t first = blocks_used_++ * kBlockSize;
        for (std::uint32_t i = 0; i < kBlockSize; ++i)
        {
            (*this)[first + i].next = i + 1 < kBlockSize ? first + i + 1 : kNone;
        }
        list.head = first;
    }

    std::vector<std::unique_ptr<Block>> blocks_; ///< Never resized: readers hold no lock.
    std::uint32_t blocks_used_{0};
    std::vector<FreeList> lists_;
    std::mutex mutex_;
};

} // namespace tactus
