// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/id_table.hpp"
#include "rt_core/spm/header.hpp"
#include "rt_core/spm/page_pool.hpp"
#include "rt_core/spm/page_slots.hpp"
#include "rt_core/spm/star_resolver.hpp"

#include <cstdint>
#include <span>

namespace tactus
{

class Linker;

/// Memory of all models' linkers, about 2.4 KB per page slot. Transport thread.
class LinkPool
{
public:
    LinkPool(Arena& arena, std::size_t slots) noexcept;

    [[nodiscard]] static constexpr std::size_t bytes_per_page() noexcept
    {
        return kRecordsPerChunk * (sizeof(StarRing) + sizeof(Waiting)) +
               kListsPerPage * sizeof(Seat) + sizeof(Resident) + sizeof(std::uint32_t) +
               2 * sizeof(IdTable::Entry);
    }

private:
    friend class Linker;

    /// A record by its place in the page slots: slot * 64 + place.
    using Seat = std::uint32_t;
    static constexpr Seat kNoSeat = 0xFFFF'FFFFU;
    /// Lists per page slot: one for four records that may wait.
    static constexpr std::size_t kListsPerPage = 16;
    static constexpr Seat kNowhere = 0xFFFF'FFFEU;
    static constexpr std::uint32_t kNotOwing = 0xFFFF'FFFFU;

    /// Entry of a list: the record that is awaited, and the next entry.
    struct Waiting
    {
        RecordId awaited{};
        Seat behind{kNowhere};

        [[nodiscard]] bool is_in_list() const noexcept { return behind != kNowhere; }
    };
    struct Resident
    {
        ChunkId chunk{};
        std::uint32_t owner{0};
        static_assert(kRecordsPerChunk <= 64);
        std::uint64_t linked{0}; ///< Linked records, one bit each.
        std::uint64_t told{0};   ///< Bits of `linked` reported to the haptic thread.
    };

    IdTable slot_of_; ///< Key: PagePool::first_key() + chunk.
    std::span<Resident> residents_;
    std::span<StarRing> rings_;  ///< Rings of linked records, by seat.
    std::span<Waiting> waiting_; ///< List entries by seat.
    std::span<Seat> lists_;      ///< First entry, by a hash of owner and awaited record.
    /// Per slot, the next slot that owes an update; itself if last, kNotOwing if it owes none.
    std::span<std::uint32_t> behind_;
};

/// Resolves parsed records of one model against the records that they depend on, and links them, on
/// the transport thread.
///
/// A record is defined in terms of the records that last changed its fan faces, and of those that
/// brought its vertices. When these are linked it is resolved (StarResolver), and `next` of each
/// fan face's owner is set to it. Records whose dependencies are absent wait, parsed, in their
/// page. The haptic thread learns of linked records through SlotQueues::arrived only: with the
/// page's arrival, and by updates afterwards (try_take_update()).
///
/// A waiting record is in the list of one awaited record, the first of its dependencies that isn't
/// linked; when that is linked, the list is checked again. So a record is checked at most once for
/// each of its dependencies, regardless of other resident records.
///
/// A page that returns after an eviction has all its `next` pending again. Linked records of other
/// pages that were named there wait from the eviction on and set them again, at the latest when all
/// their dependencies are back; they can't be split before.
///
/// Refused permanently: a walk that finds no face, a vertex off the grid, a fan face that is exact
/// or that another record splits (the first one keeps it). A linked record names only records
/// linked before it, so a dependency cycle is never linked.
class Linker
{
public:
    /// `header` and `pool` must outlive the linker; the pool has as many slots.
    Linker(LinkPool& pool, std::uint32_t owner, const ModelHeader& header,
           PageSlots slots) noexcept;

    /// Sets the base mesh of an added model, or an empty one for a removed model. No page may be
    /// resident (asserted).
    void set_base(const BaseMesh& base) noexcept;
    [[nodiscard]] bool has_base() const noexcept { return !slots_.base.faces.empty(); }
    /// Number of pages of this model.
    [[nodiscard]] std::uint32_t pages_here() const noexcept { return pages_here_; }

    /// Links all records that can be linked now, in the page parsed into `slot` and in waiting
    /// pages. Checks each record of the page, and each waiting record whose last missing dependency
    /// it was.
    void link_page(ChunkId chunk, std::uint32_t slot) noexcept;

    /// Removes the records of a slot that the haptic thread returned with its content unchanged.
    void release_page(std::uint32_t slot) noexcept;

    /// Page of which more records are linked than reported to the haptic thread.
    struct Update
    {
        ChunkId chunk{};
        std::uint32_t slot{0};
        std::uint64_t linked{0};
    };

    /// Returns the page's linked records, one bit each, to be reported with its arrival. Records
    /// linked later are owed as updates.
    [[nodiscard]] std::uint64_t tell_linked(std::uint32_t slot) noexcept;
    /// Takes the update that has been owed longest; false if none is. Only for pages that were
    /// handed over: call tell_linked() for a page right after link_page().
    [[nodiscard]] bool try_take_update(Update& update) noexcept;
    [[nodiscard]] std::uint64_t linked(std::uint32_t slot) const noexcept
    {
        TACTUS_ASSERT(slot < residents_.size());
        return residents_[slot].linked;
    }

    [[nodiscard]] std::uint32_t owner() const noexcept { return owner_; }
    [[nodiscard]] bool is_resident(ChunkId chunk) const noexcept
    {
        return slot_of(chunk) != IdTable::kAbsent;
    }
    /// Records refused since the start; each is a fault of the model or of its sender.
    [[nodiscard]] std::uint64_t records_refused() const noexcept { return refused_count_; }
    [[nodiscard]] std::uint64_t records_linked() const noexcept { return linked_count_; }
    /// Number of record checks since the start. A record's stay in the pool adds at most 1 + its
    /// number of dependencies.
    [[nodiscard]] std::uint64_t looks() const noexcept { return looks_; }

    /// Linked record, for StarResolver.
    [[nodiscard]] LinkedStar find(RecordId id) const noexcept;

private:
    using Seat = LinkPool::Seat;
    using Waiting = LinkPool::Waiting;
    using Resident = LinkPool::Resident;
    static constexpr Seat kNoSeat = LinkPool::kNoSeat;
    static constexpr std::uint32_t kNotOwing = LinkPool::kNotOwing;

    /// Queue of the slots that owe an update, oldest first.
    struct Owing
    {
        std::span<std::uint32_t> behind; ///< Span of the pool.
        std::uint32_t first{0};
        std::uint32_t last{0};
        bool is_empty{true};
    };

    void link_or_wait(Seat seat) noexcept;
    [[nodiscard]] bool try_link(Seat seat) noexcept;
    void link(Seat seat, const VsplitRecord& record, const StarRing& ring) noexcept;
    void repair_next(Seat seat) noexcept;
    void wait_for(Seat seat, RecordId awaited) noexcept;
    void wake_waiting(RecordId linked) noexcept;
    void stop_waiting(Seat seat) noexcept;
    void let_dependents_wait(Seat leaving) noexcept;
    void owe_update(std::uint32_t slot) noexcept;
    void owe_nothing(std::uint32_t slot) noexcept;
    [[nodiscard]] bool is_free_for(RecordId id, const VsplitRecord& record) const noexcept;
    [[nodiscard]] bool is_linked(RecordId record) const noexcept;
    [[nodiscard]] std::uint32_t& next_of(FaceId face, FaceState state) const noexcept;
    [[nodiscard]] std::uint32_t slot_of(ChunkId chunk) const noexcept
    {
        return pool_->slot_of_.find(PagePool::first_key(owner_) + chunk.value);
    }
    [[nodiscard]] Seat seat_of(RecordId record) const noexcept;
    [[nodiscard]] RecordId id_of(Seat seat) const noexcept;
    [[nodiscard]] VsplitRecord& record_at(Seat seat) const noexcept;
    [[nodiscard]] bool is_linked_at(Seat seat) const noexcept;
    [[nodiscard]] Seat& list_of(RecordId awaited) noexcept;

    const ModelHeader& header_;
    ModelCounts counts_;
    PageSlots slots_;
    std::uint32_t owner_;
    LinkPool* pool_;
    std::span<Resident> residents_; ///< Spans of the whole pool, like the three below.
    std::span<StarRing> rings_;
    std::span<Waiting> waiting_;
    std::span<Seat> lists_;
    Seat ready_{kNoSeat}; ///< List of records to check.
    Owing owing_;
    std::uint32_t pages_here_{0};
    std::uint64_t linked_count_{0};
    std::uint64_t looks_{0};
    std::uint64_t refused_count_{0};
};

} // namespace tactus
