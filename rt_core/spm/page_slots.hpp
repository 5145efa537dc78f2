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

/// The memory in which a model's pages live, seen by both threads. Pages and index pages are those
/// of all models, each slot of one at a time; the base mesh is the model's own. Before models it is
/// the memory in which those that come and go have theirs.
///
/// The transport thread alone writes it: a page's content while the slot is on loan to it, and
/// later only `next` (through std::atomic_ref). The haptic thread reads slots that were handed over
/// through the inbox. A record counts for it once an event from the inbox has told that it is
/// linked; it keeps those bits in its PageTable.
struct PageSlots
{
    std::span<Page> pages;
    std::span<IndexPage> index_pages;
    BaseMesh base;

    [[nodiscard]] static PageSlots take(Arena& arena, const ModelCounts& counts,
                                        std::uint32_t page_capacity,
                                        std::uint32_t index_capacity) noexcept
    {
        PageSlots slots;
        slots.pages = arena.take<Page>(page_capacity);
        slots.index_pages = arena.take<IndexPage>(index_capacity);
        return slots.of_model(arena, counts);
    }

    /// The same pages, without a base mesh so far.
    [[nodiscard]] PageSlots without_base() const noexcept { return {pages, index_pages, {}}; }
    /// The same pages, with a base mesh of its own.
    [[nodiscard]] PageSlots of_model(Arena& arena, const ModelCounts& counts) const noexcept
    {
        PageSlots slots{pages, index_pages, {}};
        slots.base.positions_m = arena.take<Vec3f>(counts.base_vertices);
        slots.base.faces = arena.take<BaseFace>(counts.base_faces);
        slots.base.next = arena.take<std::uint32_t>(counts.base_faces);
        return slots;
    }
};

/// Reads a `next` that the other thread may be writing, which is the one thing that changes while a
/// frame runs, and still no result depends on when. A `next` goes once from kNextPending to the id
/// of one record, and that is written before the record's linked bit is pushed into the inbox. So
/// whoever has taken that bit reads the id; whoever hasn't finds that the id isn't linked
/// (PageTable::find_linked), and that means the same as kNextPending. Hence relaxed, too.
[[nodiscard]] inline std::uint32_t load_next(std::uint32_t& next) noexcept
{
    return std::atomic_ref<std::uint32_t>(next).load(std::memory_order_relaxed);
}

} // namespace tactus
