// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/base/id_table.hpp"
#include "rt_core/cache/chunk_inbox.hpp"
#include "rt_core/spm/linker.hpp"
#include "rt_core/spm/page_slots.hpp"
#include "transport/chunk_link.hpp"
#include "transport/log.hpp"
#include "transport/waiting_times.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>

namespace tactus
{

/// What the transport thread did for one model since the start.
struct CourierCounters
{
    std::uint64_t pieces{0};      ///< Came in, whatever became of them.
    std::uint64_t coded_bytes{0}; ///< Of those, without the link's framing.
    std::uint64_t delivered{0};   ///< Handed over to the haptic thread.
    std::uint64_t wishes{0};      ///< Taken from the door.
    std::uint64_t asked_again{0}; ///< Repeated: nothing came, or another host serves the model.

    std::uint64_t refused_hash{0};     ///< Damaged, forged, or another piece under this key.
    std::uint64_t refused_content{0};  ///< The hash fits but parse refuses: a faulty model.
    std::uint64_t dropped_unasked{0};  ///< Duplicates, late ones, and what nobody wished for.
    std::uint64_t dropped_no_slot{0};  ///< Every slot is with the haptic thread.
    std::uint64_t dropped_no_index{0}; ///< The chunk's index page is not here to verify it.
    std::uint64_t forgotten{0};        ///< Wishes given up because too many were open.

    [[nodiscard]] std::uint64_t refused() const noexcept { return refused_hash + refused_content; }
};

struct CourierOptions
{
    std::uint32_t open_wishes{256}; ///< Asked for and not yet here. 32 B each.
};

/// The transport thread's work for one model: takes wishes from the door, asks the link, verifies
/// what comes, parses it into a free slot, links it and hands the slot over. Has no thread of its
/// own: call step() on one thread.
///
/// Trust: an index page is checked against its hash in the header, a chunk against its hash in its
/// index page, so nothing that the header's author did not write reaches a slot. A refused piece
/// changes nothing but counters; the slot it would have had stays free.
///
/// What a record waited for may come with a later page: the door is told then which records of
/// pages already handed over are linked, the latest state of a page, once there is room.
///
/// Nothing is allocated after construction (the link and the log are their own matter).
class Courier final : private PieceSink
{
public:
    /// `header`, `linker`, `inbox` and `link` must outlive the courier; `slots.base` is parsed.
    /// `name` stands in front of log lines.
    Courier(Arena& arena, const ModelHeader& header, const PageSlots& slots, Linker& linker,
            ChunkInbox& inbox, ChunkLink& link, std::string name, Log log,
            const CourierOptions& options = {});

    /// Bytes that the constructor takes from the arena.
    [[nodiscard]] static std::size_t required_bytes(std::size_t pages, std::size_t index_pages,
                                                    const CourierOptions& options = {}) noexcept;

    /// One round: freed slots, wishes, repeats, arrivals, link updates. `now_ns` is monotonic.
    void step(std::int64_t now_ns);

    /// From now on `copies` gets every piece that is handed over, in its coded form and right
    /// before; null ends it. It must outlive the courier.
    void copy_pieces_to(PieceSink* copies) noexcept { copies_ = copies; }

    [[nodiscard]] const CourierCounters& counters() const noexcept { return counters_; }
    /// From the wish for a piece until it was handed over.
    [[nodiscard]] const WaitingTimes& waiting_times() const noexcept { return waiting_times_; }
    [[nodiscard]] std::size_t open_wishes() const noexcept { return open_count_; }
    [[nodiscard]] std::size_t free_pages() const noexcept { return free_pages_.count; }
    [[nodiscard]] std::size_t free_index_pages() const noexcept { return free_index_.count; }

private:
    struct Slots
    {
        std::span<std::uint32_t> stack;
        std::size_t count{0};
    };
    struct OpenWish
    {
        ContentKey key;
        std::uint32_t generation{0};
        bool is_asked{false};
        std::int64_t opened_ns{0};
    };
    struct IndexSlot
    {
        IndexPageId page{};
        std::array<ChunkEntry, kChunksPerIndexPage> entries{};
    };

    void receive(ContentKey key, std::span<const std::byte> bytes) override;
    void take_back_freed();
    void take_wishes(std::size_t count);
    void open_wish(const ChunkInbox::Wish& wish);
    void forget_oldest_generation();
    void ask_again(OpenWish& open);
    void ask();
    void adopt_index_page(IndexPageId page, std::span<const std::byte> bytes);
    void adopt_chunk(ChunkId chunk, std::span<const std::byte> bytes);
    void hand_over(ContentKey key, std::uint32_t slot, std::uint64_t linked,
                   std::span<const std::byte> bytes);
    void push_link_updates();
    void refuse(std::uint64_t& counter, ContentKey key, const char* reason);
    [[nodiscard]] OpenWish* find_open(ContentKey key) noexcept;
    void close_wish(ContentKey key) noexcept;
    [[nodiscard]] bool is_resident(ContentKey key) const noexcept;
    [[nodiscard]] bool is_key_of_model(ContentKey key) const noexcept;
    [[nodiscard]] static Slots all_free(Arena& arena, std::size_t count) noexcept;

    const ModelHeader& header_;
    ModelCounts counts_;
    PageSlots slots_;
    Linker& linker_;
    ChunkInbox& inbox_;
    ChunkLink& link_;
    std::string name_;
    RateLimitedLog log_;
    CourierOptions options_;

    Slots free_pages_;
    Slots free_index_;
    std::span<IndexSlot> index_; ///< What verifies chunks, per index slot.
    IdTable index_slot_of_;
    std::span<OpenWish> open_; ///< The first `open_count_` are in use.
    std::size_t open_count_{0};
    std::span<ContentKey> batch_;
    std::uint32_t newest_generation_{0};
    std::uint64_t session_{0};
    std::int64_t now_ns_{0};
    std::uint32_t freed_taken_{0}; ///< Modulo 2^32, as in DoorEvent.
    PieceSink* copies_{nullptr};
    CourierCounters counters_;
    WaitingTimes waiting_times_;
};

} // namespace tactus
