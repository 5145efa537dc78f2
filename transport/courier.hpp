// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/cache/slot_door.hpp"
#include "rt_core/spm/linker.hpp"
#include "rt_core/spm/page_slots.hpp"
#include "transport/chunk_link.hpp"
#include "transport/log.hpp"
#include "transport/part_intake.hpp"
#include "transport/slot_bank.hpp"
#include "transport/waiting_times.hpp"
#include "transport/wish_clock.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

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
    std::uint64_t overdue{0};          ///< Wishes that waited for more than a second (WishClock).
    std::uint64_t overdue_came{0};     ///< Of those, what came after all.

    [[nodiscard]] std::uint64_t refused() const noexcept { return refused_hash + refused_content; }
};

struct CourierOptions
{
    /// Asked for and not yet here, 64 B each; above 0 (asserted).
    std::uint32_t open_wishes{SlotDoor::kOpenWishes};
    /// Wishes come again within kWishTimeoutFrames, or twice that; after a longer pause than this a
    /// piece was not wanted meanwhile.
    std::int64_t forgotten_ns{1'000'000'000};
};

/// The transport thread's work: takes wishes from the door, asks each model's link, verifies what
/// comes, parses it into a free slot, links it and hands the slot over. Has no thread of its own:
/// call step() on one thread.
///
/// Trust: an index page is checked against its hash in the header, a chunk against its hash in its
/// index page, so nothing that the header's author did not write reaches a slot. A refused piece
/// changes nothing but counters; the slot it would have had stays free.
///
/// What a record waited for may come with a later page: the door is told then which records of
/// pages already handed over are linked, the latest state of a page, once there is room.
///
/// A piece that doesn't come for a second is told of and counted, and again when it comes after
/// all.
///
/// A guest's base mesh comes in parts and is checked as a whole against the hash that the header
/// names, parsed into the cells that came with the wish, and handed over; the model's pages come
/// after it. When it is given back all that was linked to it has been. Where nothing of it comes
/// for a second, whether its host is gone or silent, the cells are given back; what had come is
/// kept for the next wish, which may find another host. They are given back at once when it is
/// refused, and it is asked for anew with the next wish.
///
/// Nothing is allocated after the last add() but for base meshes on their way (the links and the
/// log are their own matter).
class Courier
{
public:
    /// Slots are those of all models; they are all the courier's at first. Slots and door must
    /// outlive it.
    Courier(Arena& arena, const PageSlots& slots, SlotDoor& door, Log log,
            const CourierOptions& options = {});

    /// Bytes that the constructor takes from the arena.
    [[nodiscard]] static std::size_t required_bytes(std::size_t pages, std::size_t index_pages,
                                                    const CourierOptions& options = {}) noexcept;

    /// One model more, the linker's owner: they come in the order of their numbers, from 0. All
    /// must outlive the courier. `name` stands in front of log lines. A linker without a base mesh
    /// is a guest's: the mesh is brought when it is wished for.
    void add(const ModelHeader& header, Linker& linker, ChunkLink& link, std::string name);

    /// One round: freed slots, wishes, repeats, arrivals, link updates. `now_ns` is monotonic, of
    /// one clock. In time by what has come; a link of a file waits for its disk.
    void step(std::int64_t now_ns);

    /// From now on `copies` gets every piece of the model that is handed over, in its coded form
    /// and right before; null ends it. It must outlive the courier. Here and below there must be
    /// such a model.
    void copy_pieces_to(PieceSink* copies, std::uint32_t model = 0) noexcept
    {
        sides_[model]->copies = copies;
    }

    [[nodiscard]] std::uint32_t model_count() const noexcept
    {
        return static_cast<std::uint32_t>(sides_.size());
    }
    [[nodiscard]] const CourierCounters& counters(std::uint32_t model = 0) const noexcept
    {
        return sides_[model]->counters;
    }
    /// From the wish for a piece until it was handed over.
    [[nodiscard]] const WaitingTimes& waiting_times(std::uint32_t model = 0) const noexcept
    {
        return sides_[model]->waiting_times;
    }
    /// Whether a piece of the model is still wished for that hasn't come for more than a second.
    [[nodiscard]] bool is_starved(std::uint32_t model = 0) const noexcept;
    [[nodiscard]] std::size_t open_wishes() const noexcept { return open_count_; }
    /// Adds the chunks of the model that are wished for and haven't come, in any order.
    void add_wished_chunks(std::uint32_t model, std::vector<ChunkId>& chunks) const;
    [[nodiscard]] std::size_t free_pages() const noexcept { return bank_.free_pages(); }
    [[nodiscard]] std::size_t free_index_pages() const noexcept { return bank_.free_index_pages(); }

private:
    /// One model's.
    struct Side final : PieceSink
    {
        Side(Courier& courier, const ModelHeader& model_header, Linker& model_linker,
             ChunkLink& model_link, std::string model_name)
            : owner(courier)
            , header(model_header)
            , counts(model_header.counts())
            , linker(model_linker)
            , link(model_link)
            , name(std::move(model_name))
            , session(model_link.session())
        {
        }
        void receive(ContentKey key, std::span<const std::byte> bytes) override
        {
            owner.receive(*this, key, bytes);
        }

        Courier& owner;
        const ModelHeader& header;
        ModelCounts counts;
        Linker& linker;
        ChunkLink& link;
        std::string name;
        std::uint64_t session;
        std::size_t unasked{0}; ///< Of the open wishes.
        std::size_t overdue{0}; ///< Likewise.
        /// Of a guest whose base mesh is wanted: where it is to lie, and what has come of it.
        std::optional<std::uint32_t> base_cell;
        PartIntake base;
        bool is_base_asked{false};
        std::int64_t base_progress_ns{0}; ///< Wished for or some of it come, for the last time.
        PieceSink* copies{nullptr};
        CourierCounters counters;
        WaitingTimes waiting_times;
    };
    struct OpenWish
    {
        Side* side{nullptr};
        ContentKey key;
        std::uint32_t generation{0};
        bool is_asked{false};
        WishClock clock;
    };

    void receive(Side& side, ContentKey key, std::span<const std::byte> bytes);
    void want_base(Side& side, const PieceWish& wish);
    void bring_base(Side& side);
    void adopt_base(Side& side);
    void give_cells_back(Side& side);
    void hand_over_cells(Side& side, DoorEventKind kind);
    void take_wishes(std::size_t count);
    void open_wish(const PieceWish& wish);
    void forget_oldest_generation();
    void wish_again(OpenWish& open);
    void ask_again(OpenWish& open);
    void ask(Side& side);
    void adopt_index_page(Side& side, IndexPageId page, std::span<const std::byte> bytes);
    void adopt_chunk(Side& side, ChunkId chunk, std::span<const std::byte> bytes);
    void hand_over(Side& side, ContentKey key, std::uint32_t slot, std::uint64_t linked,
                   std::span<const std::byte> bytes);
    void push_link_updates(Side& side);
    void refuse(const Side& side, std::uint64_t& counter, ContentKey key, const char* reason);
    void tell(const Side& side, ContentKey key, std::string_view what, std::string_view more = "");
    [[nodiscard]] OpenWish* find_open(const Side& side, ContentKey key) noexcept;
    void close_wish(const Side& side, ContentKey key) noexcept;
    void remove(OpenWish& open) noexcept;
    [[nodiscard]] bool is_resident(const Side& side, ContentKey key) const noexcept;

    PageSlots slots_;
    SlotDoor& door_;
    SlotBank bank_;
    RateLimitedLog log_;
    std::span<OpenWish> open_; ///< The first `open_count_` are in use.
    std::size_t open_count_{0};
    std::span<ContentKey> batch_;
    std::int64_t forgotten_ns_;
    std::uint32_t newest_generation_{0};
    std::int64_t now_ns_{0};
    std::vector<std::unique_ptr<Side>> sides_; ///< By owner.
};

} // namespace tactus
