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

/// What linking keeps beside each page slot of all models: about 2.4 KB. Transport thread.
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
    /// A quarter of the records that may wait at most.
    static constexpr std::size_t kListsPerPage = 16;
    static constexpr Seat kNowhere = 0xFFFF'FFFEU;
    static constexpr std::uint32_t kNotOwing = 0xFFFF'FFFFU;

    /// A record in a list: for which record it waits, and who is behind it there.
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
        std::uint64_t linked{0}; ///< One bit a record.
        std::uint64_t told{0};   ///< Of `linked`, what the haptic thread was told.
    };

    IdTable slot_of_; ///< By PagePool::first_key() + chunk.
    std::span<Resident> residents_;
    std::span<StarRing> rings_;  ///< Per seat; of linked records.
    std::span<Waiting> waiting_; ///< Per seat.
    std::span<Seat> lists_;      ///< First waiting, by a hash of owner and awaited record.
    /// Per slot, the one behind it that owes an update; itself when last, kNotOwing when it
    /// doesn't.
    std::span<std::uint32_t> behind_;
};

/// Resolves parsed records of one model against the records they depend on, and links them, on the
/// transport thread.
///
/// A record says what it is in terms of records that last changed its fan faces, and of those that
/// brought its vertices. When these are linked it is resolved (StarResolver) and `next` of each
/// fan face's owner is set to it. Records whose dependencies are absent wait, parsed, in their
/// page. Which records are linked reaches the haptic thread through the inbox only: with the page's
/// arrival, and by updates afterwards (try_take_update()).
///
/// A waiting record stands in a list of those that wait for one and the same record, the first of
/// its dependencies that isn't linked; when that one is, they are looked at again. So a record is
/// looked at once for each of its dependencies at most, whatever else is resident.
///
/// A page that comes back after an eviction has all its `next` pending again. Linked records of
/// other pages that stood there wait from the eviction on, and set them anew: at the latest when
/// all that they depend on is back, which is what they need to be split.
///
/// Refused for good: a walk that finds no face, a vertex off the grid, a fan face that is exact or
/// that another record splits (the first one keeps it). Whatever is linked names only what was
/// linked before, so a dependency cycle never is.
class Linker
{
public:
    /// `header` and `pool` must outlive the linker; the pool has as many slots.
    Linker(LinkPool& pool, std::uint32_t owner, const ModelHeader& header,
           PageSlots slots) noexcept;

    /// The base mesh of a model that comes, or none of one that goes. No page is here then.
    void set_base(const BaseMesh& base) noexcept;
    [[nodiscard]] bool has_base() const noexcept { return !slots_.base.faces.empty(); }
    /// Of this model.
    [[nodiscard]] std::uint32_t pages_here() const noexcept { return pages_here_; }

    /// A page was parsed into `slot`: links what can be linked now, in it and in waiting pages.
    /// Cost: per record, and per waiting record that one of them was the last thing missing for.
    void link_page(ChunkId chunk, std::uint32_t slot) noexcept;

    /// The haptic thread gave the slot back, its content as it was; its records are gone.
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
    /// Takes the update that is owed longest; false when none is. Only for pages that were handed
    /// over: call tell_linked() for a page right after link_page().
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
    /// Records that were refused since the start; each is a fault of the model or of its sender.
    [[nodiscard]] std::uint64_t records_refused() const noexcept { return refused_count_; }
    [[nodiscard]] std::uint64_t records_linked() const noexcept { return linked_count_; }
    /// Looks at a record since the start: 1 + what it waited for at most a stay in the pools.
    [[nodiscard]] std::uint64_t looks() const noexcept { return looks_; }

    /// A record that is linked, for StarResolver.
    [[nodiscard]] LinkedStar find(RecordId id) const noexcept;

private:
    using Seat = LinkPool::Seat;
    using Waiting = LinkPool::Waiting;
    using Resident = LinkPool::Resident;
    static constexpr Seat kNoSeat = LinkPool::kNoSeat;
    static constexpr std::uint32_t kNotOwing = LinkPool::kNotOwing;

    /// Slots that owe an update, in the order in which they came to owe it.
    struct Owing
    {
        std::span<std::uint32_t> behind; ///< The pool's.
        std::uint32_t first{0};
        std::uint32_t last{0};
        bool is_empty{true};
    };

    void settle(Seat seat) noexcept;
    [[nodiscard]] bool try_link(Seat seat) noexcept;
    void link(Seat seat, const VsplitRecord& record, const StarRing& ring) noexcept;
    void mend_next(Seat seat) noexcept;
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
    std::span<Resident> residents_; ///< All of the pool's, as the three below.
    std::span<StarRing> rings_;
    std::span<Waiting> waiting_;
    std::span<Seat> lists_;
    Seat ready_{kNoSeat}; ///< Records to look at, a list of the same kind.
    Owing owing_;
    std::uint32_t pages_here_{0};
    std::uint64_t linked_count_{0};
    std::uint64_t looks_{0};
    std::uint64_t refused_count_{0};
};

} // namespace tactus
