// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/spm/base_mesh.hpp"
#include "rt_core/spm/index_page.hpp"
#include "rt_core/spm/page.hpp"

#include <atomic>
#include <cstdint>
#include <span>

namespace tactus
{

/// The memory in which a model's pages live, seen by both threads.
///
/// The transport thread alone writes it: a page's content while the slot is on loan to it, and
/// later only `next` (through std::atomic_ref) and the linked bits. The haptic thread reads slots
/// that were handed over through the inbox. A record counts for the haptic thread once its linked
/// bit, loaded with acquire, is set.
struct PageSlots
{
    std::span<Page> pages;
    std::span<std::atomic<std::uint64_t>> linked; ///< One bit a record of the page in the slot.
    std::span<IndexPage> index_pages;
    BaseMesh base;

    [[nodiscard]] static PageSlots take(Arena& arena, const ModelCounts& counts,
                                        std::uint32_t page_capacity,
                                        std::uint32_t index_capacity) noexcept
    {
        PageSlots slots;
        slots.pages = arena.take<Page>(page_capacity);
        slots.linked = arena.take<std::atomic<std::uint64_t>>(page_capacity);
        slots.index_pages = arena.take<IndexPage>(index_capacity);
        slots.base.positions_m = arena.take<Vec3f>(counts.base_vertices);
        slots.base.faces = arena.take<BaseFace>(counts.base_faces);
        slots.base.next = arena.take<std::uint32_t>(counts.base_faces);
        return slots;
    }
};

/// Reads a `next` that the other thread may be writing. Relaxed: the record it names is only used
/// after its linked bit was loaded with acquire.
[[nodiscard]] inline std::uint32_t load_next(std::uint32_t& next) noexcept
{
    return std::atomic_ref<std::uint32_t>(next).load(std::memory_order_relaxed);
}

} // namespace tactus
