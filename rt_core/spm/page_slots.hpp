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

/// Memory of a model's pages, shared by both threads. Pages and index pages are those of all
/// models, each slot used by one at a time; the base mesh is the model's own. Without a model,
/// `base` is the memory for the base meshes of streamed models.
///
/// The transport thread alone writes: a page's content while the slot is on loan to it, and later
/// only `next` (through std::atomic_ref). The haptic thread reads slots that were handed over
/// through SlotQueues::arrived. It uses a record once an event of that queue reports it as linked;
/// its PageTable holds those bits.
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

    /// The same pages, without a base mesh.
    [[nodiscard]] PageSlots without_base() const noexcept { return {pages, index_pages, {}}; }
    /// The same pages, with an own base mesh for a model of these counts.
    [[nodiscard]] PageSlots of_model(Arena& arena, const ModelCounts& counts) const noexcept
    {
        PageSlots slots{pages, index_pages, {}};
        slots.base.positions_m = arena.take<Vec3f>(counts.base_vertices);
        slots.base.faces = arena.take<BaseFace>(counts.base_faces);
        slots.base.next = arena.take<std::uint32_t>(counts.base_faces);
        return slots;
    }
};

/// Reads a `next` that the other thread may be writing. It is the only data that changes during a
/// frame, yet no result depends on when. A `next` changes once from kNextPending to the id of one
/// record, before that record's linked bit is pushed into SlotQueues::arrived. A reader that has
/// taken the bit reads the id. A reader that hasn't finds that the id isn't linked
/// (PageTable::find_linked), which means the same as kNextPending. So relaxed order suffices.
[[nodiscard]] inline std::uint32_t load_next(std::uint32_t& next) noexcept
{
    return std::atomic_ref<std::uint32_t>(next).load(std::memory_order_relaxed);
}

} // namespace tactus
