// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/arena.hpp"
#include "rt_core/cache/slot_queues.hpp"
#include "rt_core/spm/linker.hpp"
#include "rt_core/spm/page_slots.hpp"
#include "transport/chunk_link.hpp"
#include "transport/log.hpp"
#include "transport/part_intake.hpp"
#include "transport/request_clock.hpp"
#include "transport/slot_bank.hpp"
#include "transport/waiting_times.hpp"

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

/// Counts of the transport thread's work for one model since the start.
struct ChunkLoaderCounters
{
    std::uint64_t pieces{0};      ///< Pieces received, accepted or not.
    std::uint64_t coded_bytes{0}; ///< Their bytes, without the link's framing.
    std::uint64_t delivered{0};   ///< Pieces passed to the haptic thread.
    std::uint64_t requests{0};    ///< Requests taken from the haptic thread.
    /// Requests repeated: no answer, or another server has the model.
    std::uint64_t asked_again{0};

    std::uint64_t refused_hash{0}; ///< Pieces that are damaged, forged, or belong to another key.
    /// Pieces with the right hash that parse refuses: a faulty model.
    std::uint64_t refused_content{0};
    std::uint64_t dropped_unasked{0}; ///< Duplicates, late pieces and pieces without a request.
    /// Pieces for which no slot was free: the haptic thread has all.
    std::uint64_t dropped_no_slot{0};
    std::uint64_t dropped_no_index{0}; ///< Chunks whose index page is not resident to verify them.
    std::uint64_t forgotten{0};        ///< Requests given up because too many were open.
    std::uint64_t overdue{0};      ///< Requests that waited for more than a second (RequestClock).
    std::uint64_t overdue_came{0}; ///< Overdue pieces that arrived in the end.

    [[nodiscard]] std::uint64_t refused() const noexcept { return refused_hash + refused_content; }
};

struct ChunkLoaderOptions
{
    /// Maximum number of open requests, 64 B each; above 0 (asserted).
    std::uint32_t open_requests{SlotQueues::kOpenRequests};
    /// Longest pause between two requests for one piece that counts as continued demand. The haptic
    /// thread repeats a request within kRequestTimeoutFrames, or twice that.
    std::int64_t forgotten_ns{1'000'000'000};
};

/// The transport thread's work: takes requests from the haptic thread, asks each model's link,
/// verifies the pieces that arrive, parses each into a free slot, links it and passes the slot on.
/// Has no thread of its own: call step() on one thread.
///
/// Trust: an index page is checked against its hash in the header, a chunk against its hash in its
/// index page, so only data that the header's author wrote reaches a slot. A refused piece changes
/// nothing but counters; its slot stays free.
///
/// A later page may bring what a record of an earlier page needed. The haptic thread is then sent
/// the linked records of that page, in their latest state, once the queue has room.
///
/// A piece that does not arrive within a second is logged and counted, and so is its later arrival.
///
/// A streamed model's base mesh comes in parts. As a whole it is checked against the hash in the
/// header, parsed into the cells that the request named, and passed on; the model's pages follow
/// it. The base mesh is given back only after everything linked to it. If no part arrives for a
/// second, because the server is gone or silent, the cells are given back; the parts are kept for
/// the next request, which may reach another server. If the base mesh is refused, the cells are
/// given back at once, and the next request fetches it from the beginning.
///
/// Nothing is allocated after the last add(), except for base meshes in transit (and by links and
/// log).
class ChunkLoader
{
public:
    /// All slots of all models belong to the ChunkLoader at first. Slots and queues must outlive
    /// it.
    ChunkLoader(Arena& arena, const PageSlots& slots, SlotQueues& queues, Log log,
                const ChunkLoaderOptions& options = {});

    /// Bytes that the constructor takes from the arena.
    [[nodiscard]] static std::size_t
    required_bytes(std::size_t pages, std::size_t index_pages,
                   const ChunkLoaderOptions& options = {}) noexcept;

    /// Adds one model, the linker's owner; models are added in the order of their numbers, from 0.
    /// All arguments must outlive the ChunkLoader. `name` precedes log lines. A linker without a
    /// base mesh belongs to a streamed model: the mesh is fetched on request.
    void add(const ModelHeader& header, Linker& linker, ChunkLink& link, std::string name);

    /// Runs one round: freed slots, requests, repeats, arrivals, link updates. `now_ns` is
    /// monotonic, always of the same clock. The cost grows with the arrivals; a link to a file
    /// waits for its disk.
    void step(std::int64_t now_ns);

    /// Sends every piece of the model to `copies` too, in its coded form, right before it is passed
    /// on; null ends that. `copies` must outlive the ChunkLoader. The model must exist, here and
    /// below.
    void copy_pieces_to(PieceSink* copies, std::uint32_t model = 0) noexcept
    {
        sides_[model]->copies = copies;
    }

    [[nodiscard]] std::uint32_t model_count() const noexcept
    {
        return static_cast<std::uint32_t>(sides_.size());
    }
    [[nodiscard]] const ChunkLoaderCounters& counters(std::uint32_t model = 0) const noexcept
    {
        return sides_[model]->counters;
    }
    /// Times from the request for a piece until it was passed on.
    [[nodiscard]] const WaitingTimes& waiting_times(std::uint32_t model = 0) const noexcept
    {
        return sides_[model]->waiting_times;
    }
    /// True while an open request of the model has waited for more than a second.
    [[nodiscard]] bool is_starved(std::uint32_t model = 0) const noexcept;
    [[nodiscard]] std::size_t open_requests() const noexcept { return open_count_; }
    /// Appends the chunks of the model with open requests, in any order.
    void add_requested_chunks(std::uint32_t model, std::vector<ChunkId>& chunks) const;
    [[nodiscard]] std::size_t free_pages() const noexcept { return bank_.free_pages(); }
    [[nodiscard]] std::size_t free_index_pages() const noexcept { return bank_.free_index_pages(); }

private:
    /// State of one model.
    struct Side final : PieceSink
    {
        Side(ChunkLoader& chunk_loader, const ModelHeader& model_header, Linker& model_linker,
             ChunkLink& model_link, std::string model_name)
            : owner(chunk_loader)
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

        ChunkLoader& owner;
        const ModelHeader& header;
        ModelCounts counts;
        Linker& linker;
        ChunkLink& link;
        std::string name;
        std::uint64_t session;
        std::size_t unasked{0}; ///< Open requests not yet sent to the link.
        std::size_t overdue{0}; ///< Open requests that are overdue.
        /// Cells of a wanted base mesh of a streamed model; `base` has the parts received.
        std::optional<std::uint32_t> base_cell;
        PartIntake base;
        bool is_base_asked{false};
        /// Time of the first request or of the last part received.
        std::int64_t base_progress_ns{0};
        PieceSink* copies{nullptr};
        ChunkLoaderCounters counters;
        WaitingTimes waiting_times;
    };
    struct OpenRequest
    {
        Side* side{nullptr};
        ContentKey key;
        std::uint32_t generation{0};
        bool is_asked{false};
        RequestClock clock;
    };

    void receive(Side& side, ContentKey key, std::span<const std::byte> bytes);
    void want_base(Side& side, const PieceRequest& request);
    void bring_base(Side& side);
    void adopt_base(Side& side);
    void give_cells_back(Side& side);
    void hand_over_cells(Side& side, QueueEventKind kind);
    void take_requests(std::size_t count);
    void open_request(const PieceRequest& request);
    void forget_oldest_generation();
    void request_again(OpenRequest& open);
    void ask_again(OpenRequest& open);
    void ask(Side& side);
    void adopt_index_page(Side& side, IndexPageId page, std::span<const std::byte> bytes);
    void adopt_chunk(Side& side, ChunkId chunk, std::span<const std::byte> bytes);
    void hand_over(Side& side, ContentKey key, std::uint32_t slot, std::uint64_t linked,
                   std::span<const std::byte> bytes);
    void push_link_updates(Side& side);
    void refuse(const Side& side, std::uint64_t& counter, ContentKey key, const char* reason);
    void tell(const Side& side, ContentKey key, std::string_view what, std::string_view more = "");
    [[nodiscard]] OpenRequest* find_open(const Side& side, ContentKey key) noexcept;
    void close_request(const Side& side, ContentKey key) noexcept;
    void remove(OpenRequest& open) noexcept;
    [[nodiscard]] bool is_resident(const Side& side, ContentKey key) const noexcept;

    PageSlots slots_;
    SlotQueues& queues_;
    SlotBank bank_;
    RateLimitedLog log_;
    std::span<OpenRequest> open_; ///< Storage of open requests; the first `open_count_` are in use.
    std::size_t open_count_{0};
    std::span<ContentKey> batch_;
    std::int64_t forgotten_ns_;
    std::uint32_t newest_generation_{0};
    std::int64_t now_ns_{0};
    std::vector<std::unique_ptr<Side>> sides_; ///< Models by owner number.
};

} // namespace tactus
