// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/id_table.hpp"
#include "rt_core/spm/page_slots.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace tactus
{

/// Links parsed records to the records they depend on, on the transport thread.
///
/// A record depends on the records that last changed its fan faces (or on the base mesh). It is
/// linked once all of those are present and linked: its place is checked against theirs and `next`
/// of each is set to it. Records whose dependencies are absent wait, parsed, in their page. Which
/// records are linked reaches the haptic thread through the inbox only: with the page's arrival,
/// and by updates afterwards (try_take_update()).
///
/// A page that comes back after an eviction has all its `next` pending again: records of other
/// pages that were linked to it set them anew. Which pages to look at is answered by a 256-bit
/// signature per page of the chunks it refers to.
///
/// Refused for good: a state that the owner's star contradicts, a place that another record has
/// taken (the first one keeps it), a depth that is not one more than the deepest dependency. The
/// depth rule makes a dependency cycle impossible.
class Linker
{
public:
    Linker(Arena& arena, const ModelCounts& counts, PageSlots slots) noexcept;

    /// A page was parsed into `slot`: links what can be linked now, in it and in waiting pages.
    /// Cost: one signature test per resident page, 64 records in each that refers to it.
    void link_page(ChunkId chunk, std::uint32_t slot) noexcept;

    /// The haptic thread gave the slot back; its records are gone.
    void release_page(std::uint32_t slot) noexcept;

    /// A page of which more records are linked than the haptic thread has been told.
    struct Update
    {
        ChunkId chunk{};
        std::uint32_t slot{0};
        std::uint64_t linked{0};
    };

    /// The page's linked records, told with its arrival. Later ones are owed as updates.
    [[nodiscard]] std::uint64_t tell_linked(std::uint32_t slot) noexcept;
    /// Takes one update that is owed; false when none is. Only for pages that were handed over:
    /// call tell_linked() for a page right after link_page().
    [[nodiscard]] bool try_take_update(Update& update) noexcept;
    [[nodiscard]] std::uint64_t linked(std::uint32_t slot) const noexcept
    {
        return residents_[slot].linked;
    }

    [[nodiscard]] bool is_resident(ChunkId chunk) const noexcept
    {
        return slot_of_.find(chunk.value) != IdTable::kAbsent;
    }
    /// Records that were refused since the start; each is a fault of the model or of its sender.
    [[nodiscard]] std::uint64_t records_refused() const noexcept { return refused_count_; }
    [[nodiscard]] std::uint64_t records_linked() const noexcept { return linked_count_; }

private:
    struct Signature
    {
        std::array<std::uint64_t, 4> bits{};

        void add(ChunkId chunk) noexcept;
        [[nodiscard]] bool may_hold(ChunkId chunk) const noexcept;
    };
    struct Resident
    {
        ChunkId chunk{};
        Signature refers_to;
        std::uint64_t linked{0};  ///< One bit a record.
        std::uint64_t told{0};    ///< Of `linked`, what the haptic thread was told.
        std::uint64_t refused{0}; ///< One bit a record.
        bool changed{false};      ///< Came in or gained linked records; others must look at it.
    };
    enum class Fit : std::uint8_t
    {
        fits,
        waits,
        refused
    };

    void sign(std::uint32_t slot) noexcept;
    void look_again(std::uint32_t slot, ChunkId changed) noexcept;
    void relink_next(std::uint32_t slot, std::uint32_t place, ChunkId changed) noexcept;
    void try_link(std::uint32_t slot, std::uint32_t place) noexcept;
    [[nodiscard]] Fit fit(RecordId id, const VsplitRecord& record) const noexcept;
    [[nodiscard]] Fit fit_one(RecordId id, const VsplitRecord& record, std::uint32_t fan_place,
                              std::uint32_t& depth) const noexcept;
    [[nodiscard]] std::uint32_t* next_of(FaceId face, FaceState state) const noexcept;
    [[nodiscard]] bool has_waiting_records(std::uint32_t slot) const noexcept;
    [[nodiscard]] bool is_linked(std::uint32_t slot, std::uint32_t place) const noexcept;

    ModelCounts counts_;
    PageSlots slots_;
    IdTable slot_of_;
    std::span<Resident> residents_;
    std::uint32_t slots_in_use_end_{0};
    std::uint32_t update_cursor_{0}; ///< No slot before it owes an update.
    bool any_released_{false};
    std::uint64_t linked_count_{0};
    std::uint64_t refused_count_{0};
};

} // namespace tactus
