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
/// A waiting record stands in a list of those that wait for one and the same record, the first of
/// its dependencies that isn't linked; when that one is, they are looked at again. So a record is
/// looked at once for each of its dependencies at most, whatever else is resident.
///
/// A page that comes back after an eviction has all its `next` pending again. Linked records of
/// other pages that stood there wait from the eviction on, and set them anew: at the latest when
/// all that they depend on is back, which is what they need to be split.
///
/// Refused for good: a state that the owner's star contradicts, a place that another record has
/// taken (the first one keeps it), a depth that is not one more than the deepest dependency. The
/// depth rule makes a dependency cycle impossible.
class Linker
{
public:
    Linker(Arena& arena, const ModelCounts& counts, PageSlots slots) noexcept;

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
        return residents_[slot].linked;
    }

    [[nodiscard]] bool is_resident(ChunkId chunk) const noexcept
    {
        return slot_of_.find(chunk.value) != IdTable::kAbsent;
    }
    /// Records that were refused since the start; each is a fault of the model or of its sender.
    [[nodiscard]] std::uint64_t records_refused() const noexcept { return refused_count_; }
    [[nodiscard]] std::uint64_t records_linked() const noexcept { return linked_count_; }
    /// Looks at a record since the start: 1 + its dependencies at most a stay in the pools.
    [[nodiscard]] std::uint64_t looks() const noexcept { return looks_; }

private:
    /// A record by its place in the page slots: slot * 64 + place.
    using Seat = std::uint32_t;
    static constexpr Seat kNoSeat = (1U << 29U) - 1;

    /// Why a record is in a list, and who is behind it there.
    struct Waiting
    {
        static constexpr std::uint32_t kNowhere = 0xFFFF'FFFFU;

        /// 29 bits of the next seat, 3 bits of the fan place whose owner is waited for.
        std::uint32_t value{kNowhere};

        [[nodiscard]] bool is_in_list() const noexcept { return value != kNowhere; }
        [[nodiscard]] Seat behind() const noexcept { return value >> 3U; }
        [[nodiscard]] std::uint32_t fan_place() const noexcept { return value & 7U; }
    };
    struct Resident
    {
        ChunkId chunk{};
        std::uint64_t linked{0};  ///< One bit a record.
        std::uint64_t told{0};    ///< Of `linked`, what the haptic thread was told.
        std::uint64_t refused{0}; ///< One bit a record.
    };
    /// Slots that may owe an update, in the order in which they came to owe it.
    struct Owing
    {
        std::span<std::uint32_t> behind; ///< Per slot; itself when last, kNotOwing when not here.
        std::uint32_t first{0};
        std::uint32_t last{0};
        bool is_empty{true};
    };
    static constexpr std::uint32_t kNotOwing = 0xFFFF'FFFFU;

    void settle(Seat seat) noexcept;
    [[nodiscard]] bool try_link(Seat seat) noexcept;
    void refuse(Seat seat) noexcept;
    void mend_next(Seat seat) noexcept;
    void wait_for_owner(Seat seat, std::uint32_t fan_place) noexcept;
    void wake_waiting(RecordId linked) noexcept;
    void stop_waiting(Seat seat) noexcept;
    void let_dependents_wait(Seat leaving) noexcept;
    void owe_update(std::uint32_t slot) noexcept;
    [[nodiscard]] bool is_possible(RecordId id, const VsplitRecord& record,
                                   std::uint32_t fan_place) const noexcept;
    [[nodiscard]] bool owner_is_linked(FaceState state) const noexcept;
    /// The owner of a state whose page is resident.
    [[nodiscard]] VsplitRecord& owner(FaceState state) const noexcept;
    [[nodiscard]] std::uint32_t& next_of(FaceId face, FaceState state) const noexcept;
    [[nodiscard]] Seat seat_of(RecordId record) const noexcept;
    [[nodiscard]] RecordId id_of(Seat seat) const noexcept;
    [[nodiscard]] VsplitRecord& record_at(Seat seat) const noexcept;
    [[nodiscard]] bool is_linked(Seat seat) const noexcept;
    [[nodiscard]] Seat& list_of(RecordId awaited) noexcept;

    ModelCounts counts_;
    PageSlots slots_;
    IdTable slot_of_;
    std::span<Resident> residents_;
    std::span<Waiting> waiting_; ///< Per seat.
    std::span<Seat> lists_;      ///< First waiting, by a hash of the record that is waited for.
    Seat ready_{kNoSeat};        ///< Records to look at, a list of the same kind.
    Owing owing_;
    std::uint64_t linked_count_{0};
    std::uint64_t looks_{0};
    std::uint64_t refused_count_{0};
};

} // namespace tactus
